"""What decides how a picture looks: its fingerprint tells whether a file still matches."""

from __future__ import annotations

import sys
from importlib import metadata
from typing import Any

import firetwin_core

from ..run.content import inputs
from ..shot import passes, schema
from ..shot.settings import Settings
from .picture import Picture

Fingerprints = dict[tuple[str, str], dict[str, Any]]
"""By camera and pass."""


def of_picture(settings: Settings, run: dict[str, str], camera: str, name: str) -> dict[str, Any]:
    """What a camera's frames in one pass depend on: settings of that camera and no other.

    Parameters
    ----------
    run
        Hashes of the run's fields.
    """
    return {
        "versions": versions(),
        "run": run,
        "camera": camera,
        "pass": name,
        "settings": schema.chosen(settings, passes.known()[name].aspects, camera),
    }


def versions() -> dict[str, str]:
    """Versions of Firetwin and of Blender, which need not be loaded for it."""
    if "bpy" in sys.modules:
        blender = ".".join(str(part) for part in sys.modules["bpy"].app.version)
    else:
        try:
            blender = metadata.version("bpy")
        except metadata.PackageNotFoundError:
            blender = "none"
    return {"firetwin": firetwin_core.__version__, "blender": blender}


def of_pictures(settings: Settings, pictures: list[Picture]) -> Fingerprints:
    """Those of every (camera, pass) among the pictures, and of the passes that these are made from."""
    return of_pairs(
        settings,
        [(p.camera, name) for p in pictures for name in (p.name, *passes.known()[p.name].needs)],
    )


def of_pairs(settings: Settings, pairs: list[tuple[str, str]]) -> Fingerprints:
    """Those of each (camera, pass); the run is hashed once."""
    run = inputs(settings.run)
    return {pair: of_picture(settings, run, *pair) for pair in sorted(set(pairs))}
