"""Darken the visible picture by eye-dome lighting from depth."""

from __future__ import annotations

from collections.abc import Mapping

from firetwin_core import sensor

from ...shot.shot import Shot
from . import Files

STRENGTH, RADIUS = 4.0, 1


def finish(files: Files, needed: Mapping[str, Files], _shot: Shot, _camera: str, _frame: int) -> None:
    """Darken the picture by eye-dome lighting from depth."""
    depth = sensor.read_image(needed["depth"]["exr"])[..., 0]
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    sensor.write_image(files["png"], rgb * sensor.eye_dome(depth, STRENGTH, RADIUS)[..., None])
