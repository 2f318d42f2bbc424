"""Which shots are asked for, and which of them are finished already. Needs no Blender."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Any

from .. import frame_list
from ..errors import UsageError
from ..project import Camera, Project
from . import manifest, passes
from .manifest import fingerprint
from .passes import Shot

Settings = dict[tuple[str, str], dict[str, Any]]


def shots(
    project: Project, frames: str = "", camera: str | None = None, names: str | None = None
) -> list[Shot]:
    """Shots of the scene file, or those of them that the command line picks, camera by camera.

    Parameters
    ----------
    frames
        Such as "1-10"; of each camera's own frames, these. Empty: all.
    camera
        Only this one.
    names
        Such as "rgb,thermal"; in place of the passes that the scene file gives.

    Raises
    ------
    UsageError
        A frame, camera or pass that is not there, or nothing left to do.
    """
    try:
        wanted = set(frame_list.parse(frames, project.time.frames))
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None
    cameras = [_camera(project, camera)] if camera else project.cameras
    if not cameras:
        raise UsageError(f"{project.path} has no [[cameras]], so there is nothing to render")
    chosen = _passes(names) if names is not None else None
    found = [
        Shot(c.name, frame, name)
        for c in cameras
        for frame in camera_frames(project, c)
        if frame in wanted
        for name in chosen or passes.of_camera(project, c)
    ]
    if not found:
        raise UsageError(
            f"--frames {frames}: {' and '.join(c.name for c in cameras)} has none of these frames"
        )
    return found


def camera_frames(project: Project, camera: Camera) -> list[int]:
    """Frames that a camera films, ascending."""
    return frame_list.parse(camera.frames, project.time.frames)


def missing(out: Path, wanted: list[Shot], settings: Settings) -> list[Shot]:
    """Those of the shots whose files are not there, are damaged, or were made with other settings."""
    finished = manifest.load(out)
    keys = {which: fingerprint(values) for which, values in settings.items()}
    return [
        shot
        for shot in wanted
        if not manifest.intact(out, finished, keys[shot.camera, shot.name], shot.files())
    ]


def _camera(project: Project, name: str) -> Camera:
    for camera in project.cameras:
        if camera.name == name:
            return camera
    names = [camera.name for camera in project.cameras]
    raise UsageError(f'--camera: there is no "{name}"; the scene has {", ".join(names) or "none"}')


def _passes(text: str) -> tuple[str, ...]:
    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in passes.ALL:
            near = difflib.get_close_matches(name, passes.ALL, n=1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise UsageError(f'--passes: "{name}" is not one of {", ".join(passes.ALL)}{hint}')
    return tuple(name for name in passes.ALL if name in names)
