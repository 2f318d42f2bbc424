"""Overlay pass: infrared hot spots over the visible picture, from 350 K on, opaque from 450 K.

Sunlit ground stays below, and ground that burned minutes ago shows faintly (`air_temperature.cooling`).
The two temperatures are chosen by eye. The palette resembles ironbow, on the scale of the thermal picture.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import DerivedPass, Files, thermal

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot

START, FULL, OPACITY = 350.0, 450.0, 0.9


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, _camera: str, frame: int) -> None:
    """Blend the hot spots over the picture."""
    from firetwin_core import sensor

    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    kelvin = sensor.read_image(needed["thermal"]["exr"])[..., 0]
    hot = sensor.colour(kelvin, *thermal.scale(shot, frame), "ironbow", thermal.KNEE)
    sensor.write_image(files["png"], sensor.overlay(rgb, hot, kelvin, START, FULL, OPACITY))


PASS = DerivedPass(
    name="overlay",
    order=45,
    help="Visible picture overlaid with the hot spots of the thermal pass",
    files=("png",),
    film=True,
    needs=("rgb", "thermal"),
    finish=finish,
)
