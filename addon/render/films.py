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


def missing(project: Project, run: Run, out: Path, settings: plan.Settings) -> list[Film]:
    """Films of at least two pictures that are not there, are damaged, or are not of the pictures there are.

    Only pictures made with these `settings`, by camera and pass, belong in a film.
    """
    if not project.render.video:
        return []
    finished = manifest.load(out)
    found = []
    for camera in project.cameras:
        for name in passes.FILMED:
            if (camera.name, name) not in settings:
                continue
            key = fingerprint(settings[camera.name, name])
            pictures = [
                [frame, entry["sha256"]]
                for frame in plan.camera_frames(project, camera)
                if (entry := finished["files"].get(Shot(camera.name, frame, name).file("png")))
                and entry["settings"] == key
            ]
            film = _settings(project, run, camera.name, name, pictures)
            path = passes.film(camera.name, name)
            if len(pictures) > 1 and not manifest.intact(out, finished, fingerprint(film), [path]):
                found.append((camera.name, name, film))
    return found


def _settings(
    project: Project, run: Run, camera: str, name: str, pictures: list[list[Any]]
) -> dict[str, Any]:
    """What decides a film: its pictures (frame, hash), its rate and its captions."""
    return {
        "film": name,
        "camera": camera,
        "frames": pictures,
        "fps": project.time.fps,
        "captions": [*times.window(project, run), project.time.frames, project.time.zone, run.synthetic],
    }
