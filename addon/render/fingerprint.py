"""What decides how a shot looks: the settings whose fingerprint tells whether a file still matches."""

from __future__ import annotations

import sys
from dataclasses import fields, is_dataclass
from datetime import datetime
from importlib import metadata
from typing import Any

import firetwin_core

from ..content import inputs
from ..project import Project
from .passes import Shot


def of_shot(project: Project, hashes: dict[str, str], camera: str, name: str) -> dict[str, Any]:
    """Settings that a camera's frames in one pass depend on, and no others.

    All cameras belong to it: the ground is finer and trees stand closer where any of them flies.
    """
    render = project.render
    settings: dict[str, Any] = {
        "versions": versions(),
        "run": hashes,
        "camera": camera,
        "pass": name,
        "cameras": [_plain(c, leave_out=("passes", "frames")) for c in project.cameras],
        "seed": project.seed,
        "time": _plain(project.time, leave_out=("fps", "zone")),
        "terrain": _plain(project.terrain),
        "forest": _plain(project.forest),
        "render": {"engine": render.engine, "resolution": list(render.resolution)},
    }
    if name != "depth":
        settings |= {part: _plain(getattr(project, part)) for part in ("fire", "smoke", "light")}
        settings["render"] |= {"samples": render.samples, "denoise": render.denoise, "seed": render.seed}
    if name == "thermal":
        settings["render"] |= {"thermal_low": render.thermal_low, "thermal_high": render.thermal_high}
    return settings


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


def by_shot(project: Project, shots: list[Shot]) -> dict[tuple[str, str], dict[str, Any]]:
    """Settings of every (camera, pass) among the shots, and of rgb, which thermal pictures are made from."""
    return of_pairs(project, [(shot.camera, name) for shot in shots for name in (shot.name, "rgb")])


def of_pairs(project: Project, pairs: list[tuple[str, str]]) -> dict[tuple[str, str], dict[str, Any]]:
    """Settings of each (camera, pass); the run is hashed once."""
    hashes = inputs(project.run)
    return {pair: of_shot(project, hashes, *pair) for pair in sorted(set(pairs))}


def _plain(thing: Any, leave_out: tuple[str, ...] = ()) -> Any:
    """A dataclass as JSON can carry it."""
    if is_dataclass(thing):
        return {f.name: _plain(getattr(thing, f.name)) for f in fields(thing) if f.name not in leave_out}
    if isinstance(thing, tuple):
        return [_plain(part) for part in thing]
    return thing.isoformat() if isinstance(thing, datetime) else thing
