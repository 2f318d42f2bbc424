"""Volume files of built smoke: their folder, missing frames, and the scene file that they are made from."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import bpy

from ...blender import owned
from ...blender.owned import Stage
from ...smoke import bake
from . import notice

_SCENE_FILE, _RUN = "firetwin_scene_file", "firetwin_run"


def store_source(stage: Stage, scene_file: str, run: str) -> None:
    """Store the scene file's text of a build, and the name of its run in [[runs]] (empty: the first)."""
    stage.root[_SCENE_FILE], stage.root[_RUN] = scene_file, run


def read_source(stage: Stage) -> tuple[str, str]:
    """Return the stored text and run name; empty texts if an earlier version built the scene."""
    return stage.root.get(_SCENE_FILE, ""), stage.root.get(_RUN, "")


def volumes(stage: Stage) -> list[bpy.types.Object]:
    """Return the volume objects of the smoke; the last one's file is the last of a frame to be written."""
    return [obj for obj in stage.objects_of("Smoke") if obj.type == "VOLUME"]


def are_rendered(stage: Stage) -> bool:
    """Return whether Blender's own render of the scene shows the smoke volumes."""
    shown = {obj.name for layer in stage.scene.view_layers if layer.use for obj in layer.objects}
    return any(not obj.hide_render and obj.name in shown for obj in volumes(stage))


def folder(stage: Stage) -> Path | None:
    """Return the folder of the volume files; None without smoke."""
    found = _last(stage)
    return Path(bpy.path.abspath(found.filepath)).parent if found else None


def count(stage: Stage) -> int:
    """Return the number of frames that can have volumes; 0 without smoke."""
    found = _last(stage)
    return found.frame_duration if found else 0


def missing(stage: Stage, frames: Iterable[int] | None = None) -> list[int]:
    """Return the frames whose volumes are missing, among `frames` or among all frames of the smoke."""
    place, last = folder(stage), count(stage)
    if place is None:
        return []
    wanted = range(1, last + 1) if frames is None else [frame for frame in frames if 1 <= frame <= last]
    paths = {frame: bake.volume_path(place, frame) for frame in wanted}
    if len(paths) == 1:
        there = {path.name for path in paths.values() if path.exists()}
    else:  # one request for all frames of a long film, on a network share too
        there = set(os.listdir(place)) if place.is_dir() else set()
    return [frame for frame, path in paths.items() if path.name not in there]


def set_folder(stage: Stage, place: Path) -> None:
    """Let the volumes read their files from another folder."""
    for obj in volumes(stage):
        relative = obj.data.filepath.startswith("//")
        path = str(place / Path(obj.data.filepath).name)
        obj.data.filepath = _relative_path(Path(bpy.data.filepath), path) if relative else path
    notice.set_folder(stage, _last_path(stage))


def reload(stage: Stage) -> None:
    """Let Blender read volume files that were written after it looked for them."""
    for obj in volumes(stage):
        obj.data.grids.unload()
        obj.data.update_tag()
    notice.update(stage)


def make_paths_relative(blend: Path) -> None:
    """Make paths of Firetwin's volumes relative to the folder in which the .blend file will be saved.

    Smoke then stays linked when both are moved together. Paths on another drive stay absolute. Blender must
    not remap the paths again: save with ``relative_remap=False``.
    """
    for volume in bpy.data.volumes:
        if owned.is_ours(volume):
            volume.filepath = _relative_path(blend, bpy.path.abspath(volume.filepath))
    for scene in bpy.data.scenes:
        if owned.has_data(scene):
            stage = owned.stage(scene)
            notice.set_folder(stage, _last_path(stage))


def _last(stage: Stage) -> bpy.types.Volume | None:
    found = volumes(stage)
    return found[-1].data if found else None


def _last_path(stage: Stage) -> str:
    """Return the path of the last volume in the form in which it is stored; empty without smoke."""
    found = _last(stage)
    return found.filepath if found else ""


def _relative_path(blend: Path, path: str) -> str:
    try:
        return "//" + Path(os.path.relpath(path, blend.absolute().parent)).as_posix()
    except ValueError:  # no relative path leads to another drive
        return path
