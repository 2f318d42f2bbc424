"""What the panel says as settings, and scene files in and out of it.

What is built and rendered is always the scene file that the panel would export: `written` writes it, and the
jobs are given its name.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

import bpy

from .. import files
from ..errors import Error
from ..shot.settings import scene_file, toml_update
from ..shot.settings.schema import validate
from ..shot.settings.settings import Settings
from . import camera_edits, camera_list, keys, other_runs, sections


def settings(scene: bpy.types.Scene, path: Path = Path("scene.toml")) -> Settings:
    """What the panel of a scene says, checked, as the settings of the file `path`.

    Raises
    ------
    Error
        Says what is wrong, in the panel's words.
    """
    panel = scene.firetwin
    cache = panel.cache or output(panel, "cache") or own_folder() / "cache"
    run, cache = (Path(bpy.path.abspath(str(path))) for path in (panel.run, cache))
    cameras, runs = camera_list.cameras(panel), other_runs.runs(panel)
    whole = Settings(path=path, run=run, cache=cache, cameras=cameras, runs=runs)
    whole = sections.take(panel, sections.single() + sections.sections(), whole)
    if found := validate(whole):
        raise Error(keys.sentence(found[1]))
    return whole


def fill(scene: bpy.types.Scene, whole: Settings) -> None:
    """Let the panel of a scene say these settings; the run is looked into."""
    panel = scene.firetwin
    sections.put(panel, sections.single() + sections.sections(), whole)
    camera_list.fill(panel, whole.cameras)
    other_runs.fill(panel, whole.runs)
    panel.cache = str(whole.cache.absolute())
    panel.run = str(whole.run.absolute())


def output(panel: bpy.types.PropertyGroup, *inside: str) -> str:
    """The output folder, or what is in it; empty while it hangs on a .blend file that is not saved."""
    if panel.output.startswith("//") and not bpy.data.filepath:
        return ""
    return str(Path(bpy.path.abspath(panel.output), *inside)) if panel.output else ""


def own_folder() -> Path:
    """Where Firetwin keeps files of its own on this computer; they go with the extension."""
    try:
        return Path(bpy.utils.extension_path_user(__package__.rpartition(".")[0]))
    except ValueError:  # not installed as an extension
        return Path(bpy.utils.user_resource("DATAFILES", path="firetwin"))


def export(scene: bpy.types.Scene, path: Path) -> None:
    """Write what the panel says, with what was done to cameras by hand, as a scene file.

    In a file that is there only what changed is written; its comments and layout stay.

    Raises
    ------
    Error
        The panel holds what no scene file may.
    InputError
        It cannot be written.
    """
    camera_edits.pull(scene)
    toml_update.save(settings(scene, path))


def folder() -> Path:
    """Where scene files lie that are written for the jobs alone, until Blender ends."""
    return Path(bpy.app.tempdir) / "firetwin"


def written(scene: bpy.types.Scene) -> Path:
    """The panel's scene file, written for a job; another text gets another name."""
    text = scene_file.text(settings(scene, folder() / "scene.toml"))
    path = folder() / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}.toml"
    if not path.is_file():
        files.write(path, lambda part: part.write_text(text, encoding="utf-8"))
    return path
