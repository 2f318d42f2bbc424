"""Overlay pass: infrared hot spots above 350 K over the visible picture, opaque above 450 K.

Sunlit ground stays below, and ground that burned minutes ago shows faintly (`air_temperature.cooling`).
The two temperatures are chosen by eye. The palette resembles ironbow, on the scale of the thermal picture.
"""

from __future__ import annotations

from collections.abc import Mapping

from firetwin_core import sensor

from ..shot.passes import DerivedPass, Files
from ..shot.shot import Shot
from . import thermal

ORDER = 45
HELP = "Visible picture overlaid with the hot spots of the thermal pass"

PASS = DerivedPass(files=("png",), film=True, needs=("rgb", "thermal"))

START, FULL, OPACITY = 350.0, 450.0, 0.9


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, _camera: str, frame: int) -> None:
    """Blend the hot spots over the picture."""
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    kelvin = sensor.read_image(needed["thermal"]["exr"])[..., 0]
    hot = sensor.colour(kelvin, *thermal.scale(shot, frame), "ironbow", thermal.KNEE)
    sensor.write_image(files["png"], sensor.overlay(rgb, hot, kelvin, START, FULL, OPACITY))
