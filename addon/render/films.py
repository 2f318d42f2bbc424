"""Which films are missing or older than their frames. Needs no Blender."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from firetwin_core.run import Run

from .. import times
from ..project import Project
from . import manifest, passes, plan
from .manifest import fingerprint
from .passes import Shot

Film = tuple[str, str, dict[str, Any]]
"""Camera, pass, and what the film is made from."""


def missing(project: Project, run: Run, out: Path) -> list[Film]:
    """Films of at least two finished frames that are not there, are damaged, or whose frames have changed."""
    if not project.render.video:
        return []
    finished = manifest.load(out)
    found = []
    for camera in project.cameras:
        for name in passes.FILMED:
            settings = _settings(
                project, run, finished, camera.name, plan.camera_frames(project, camera), name
            )
            path = passes.film(camera.name, name)
            enough = len(settings["frames"]) > 1
            if enough and not manifest.intact(out, finished, fingerprint(settings), [path]):
                found.append((camera.name, name, settings))
    return found


def _settings(
    project: Project, run: Run, finished: dict[str, Any], camera: str, frames: list[int], name: str
) -> dict[str, Any]:
    """What decides a film: its finished pictures (frame, hash), its rate and its captions."""
    pictures = {frame: finished["files"].get(Shot(camera, frame, name).file("png")) for frame in frames}
    return {
        "film": name,
        "camera": camera,
        "frames": [[frame, entry["sha256"]] for frame, entry in pictures.items() if entry],
        "fps": project.time.fps,
        "captions": [*times.window(project, run), project.time.frames, project.time.zone, run.synthetic],
    }
