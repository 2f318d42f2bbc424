"""Which films are missing or older than their frames. Needs no Blender."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..shot import passes
from ..shot.shot import Shot
from . import store
from .fingerprint import Fingerprints
from .picture import Picture, film
from .store import fingerprint

Film = tuple[str, str, dict[str, Any]]
"""Camera, pass, and what the film is made from."""


def missing(shot: Shot, out: Path, made_with: Fingerprints) -> list[Film]:
    """Films of at least two pictures that are not there, are damaged, or are not of the pictures there are.

    Only pictures made with these settings, by camera and pass, belong in a film, and only those that are
    still there.
    """
    if not shot.settings.render.video:
        return []
    finished = store.load(out)
    found = []
    for camera in shot.settings.cameras:
        for name in [each.name for each in passes.known().values() if each.filmed]:
            if (camera.name, name) not in made_with:
                continue
            key = fingerprint(made_with[camera.name, name])
            pictures = [
                [frame, finished["files"][path]["sha256"]]
                for frame in shot.frames_of(camera)
                if store.intact(out, finished, key, [path := Picture(camera.name, frame, name).file("png")])
            ]
            made_from = _made_from(shot, camera.name, name, pictures)
            path = film(camera.name, name)
            if len(pictures) > 1 and not store.intact(out, finished, fingerprint(made_from), [path]):
                found.append((camera.name, name, made_from))
    return found


def _made_from(shot: Shot, camera: str, name: str, pictures: list[list[Any]]) -> dict[str, Any]:
    """What decides a film: its pictures (frame, hash), its rate and its captions."""
    time, frames = shot.settings.time, shot.frames
    return {
        "film": name,
        "camera": camera,
        "frames": pictures,
        "fps": time.fps,
        "captions": [frames.first, frames.last, frames.count, time.zone, shot.run.synthetic],
    }
