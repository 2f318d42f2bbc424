"""Blend infrared hot spots over the visible picture."""

from __future__ import annotations

from collections.abc import Mapping

from firetwin_core import sensor

from ...shot.shot import Shot
from . import Files, thermal

START, FULL, OPACITY = 350.0, 450.0, 0.9


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, _camera: str, frame: int) -> None:
    """Blend the hot spots over the picture."""
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    kelvin = sensor.read_image(needed["thermal"]["exr"])[..., 0]
    hot = sensor.colour(kelvin, *thermal.scale(shot, frame), "ironbow", thermal.KNEE)
    sensor.write_image(files["png"], sensor.overlay(rgb, hot, kelvin, START, FULL, OPACITY))
