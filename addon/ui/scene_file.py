"""Scene file of the panel: its values as settings, import and export.

Build and render always use the scene file that the panel would export: `write_temporary` writes it, and jobs
receive its path.
"""

from __future__ import annotations

import hashlib
import os
from dataclasses import replace
from pathlib import Path

import bpy

from .. import files, output
from ..blender import compat
from ..errors import Error
from ..shot.schema import validate
from ..shot.settings import Settings, scene_file, toml_update
from ..shot.source import ShotSource
from . import camera_edits, camera_list, keys, other_runs, preferences, sections


def read_settings(scene: bpy.types.Scene, path: Path = Path("scene.toml")) -> Settings:
    """Return the validated settings of a scene's panel, as if read from the file `path`.

    Raises
    ------
    Error
        A value is invalid; the message uses the panel's labels.
    """
    panel = scene.firetwin
    cache = panel.cache or preferences.cache_folder()
    cache = cache or output_folder(panel, "cache") or own_folder() / "cache"
    run, cache = (Path(bpy.path.abspath(str(path))) for path in (panel.run, cache))
    cameras, runs = camera_list.cameras(panel), other_runs.list_runs(panel)
    whole = Settings(path=path, run=run, cache=cache, cameras=cameras, runs=runs)
    whole = sections.take(panel, sections.top_level_keys() + sections.sections(), whole)
    places = tuple(bpy.path.abspath(each) if each.startswith("//") else each for each in whole.tiles.sources)
    whole = replace(whole, tiles=replace(whole.tiles, sources=places))
    if mistake := validate(whole):
        raise Error(keys.sentence(mistake[1]))
    return whole


def fill(scene: bpy.types.Scene, whole: Settings, inspect: bool = True) -> None:
    """Set the panel of a scene to these settings, and inspect the run."""
    panel = scene.firetwin
    whole = scene_file.with_absolute_tilesets(whole)
    sections.put(panel, sections.top_level_keys() + sections.sections(), whole)
    camera_list.fill(panel, whole.cameras)
    other_runs.fill(panel, whole.runs)
    panel.cache = str(whole.cache.absolute())
    run = str(whole.run.absolute())
    if inspect:
        panel.run = run
    else:  # without its update callback
        compat.stored_properties(scene)["firetwin"]["run"] = run


def shot_source(panel: bpy.types.PropertyGroup) -> ShotSource:
    """Return the shot source of the panel and the preferences, with manual edits of cameras."""
    camera_edits.read_camera_edits(panel.id_data)
    return ShotSource(str(write_temporary(panel.id_data)), device=preferences.device())


def output_folder(panel: bpy.types.PropertyGroup, *inside: str) -> str:
    """Return the output folder, or its default; empty while it depends on an unsaved .blend file."""
    return resolve_path(panel.output, *inside)


def resolve_path(folder: str, *inside: str) -> str:
    """Return the path in a folder property; empty while it depends on an unsaved .blend file."""
    if folder.startswith("//") and not bpy.data.filepath:
        return ""
    return str(Path(bpy.path.abspath(folder), *inside)) if folder else ""


def own_folder() -> Path:
    """Return the folder of Firetwin's files on this computer, which is removed with the extension."""
    try:
        return Path(bpy.utils.extension_path_user(__package__.rpartition(".")[0]))
    except ValueError:  # not installed as an extension
        return Path(bpy.utils.user_resource("DATAFILES", path="firetwin"))


def export(scene: bpy.types.Scene, path: Path) -> None:
    """Write the panel's settings, with manual edits of cameras, as a scene file.

    In an existing file only changed values are written; its comments and layout do not change.

    Raises
    ------
    Error
        The panel holds a value that is invalid in a scene file.
    InputError
        The file cannot be written.
    """
    camera_edits.read_camera_edits(scene)
    toml_update.save(read_settings(scene, path))


def temporary_folder() -> Path:
    """Return the temporary folder of scene files for jobs, which exists until Blender ends."""
    return Path(bpy.app.tempdir) / "firetwin"


def write_temporary(scene: bpy.types.Scene) -> Path:
    """Write the panel's scene file for a job; its name contains a digest of its text."""
    text = scene_file.text(read_settings(scene, temporary_folder() / "scene.toml"))
    path = temporary_folder() / f"{_digest(text)}.toml"
    if not path.is_file():
        files.write_text(path, text)
    return path


def write_next_to_blend(scene: bpy.types.Scene) -> tuple[Path, bool]:
    """Write the panel's scene file next to the saved .blend file, for other computers.

    Its name contains a digest of its text, so that later changes do not affect the scene of an earlier job.

    Returns
    -------
    path, whether it is new

    Raises
    ------
    InputError
        Another file has this name, or the file cannot be written.
    """
    blend = Path(bpy.data.filepath)
    text = scene_file.text(read_settings(scene, blend.with_suffix(".toml")))
    path = blend.with_name(f"{blend.stem}_farm_{_digest(text)[:8]}.toml")
    fresh = not os.path.lexists(path)
    if fresh or not output.is_own(path):
        output.write_text(path, text)
    return path, fresh


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
