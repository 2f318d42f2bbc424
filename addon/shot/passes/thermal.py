"""Temperatures in kelvin, as a long-wave infrared camera (8 to 14 um) measures them.

Smoke is left out, as infrared sees through most of it, and so are the lamps that light ground and trees in
place of the flames. A pixel is the mean over itself, as in a detector. The EXR holds kelvin; the PNG is the
visible picture with a colour gradient of the temperatures added, as in the paper.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from . import Pass

if TYPE_CHECKING:
    from ..settings import Settings


def add_gradient(
    files: Mapping[str, Path], needed: Mapping[str, Mapping[str, Path]], settings: Settings
) -> None:
    """Write the PNG: the gradient of the temperatures added to the visible picture."""
    from firetwin_core import sensor

    kelvin = sensor.read_image(files["exr"])[..., 0]
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    low, high = settings.render.thermal_low, settings.render.thermal_high
    sensor.write_image(files["png"], sensor.thermal_composite(rgb, kelvin, low, high))


PASS = Pass(
    name="thermal",
    order=30,
    help="Temperature in kelvin, 32-bit EXR, and the picture with its gradient added",
    files=("exr", "png"),
    output="Image",
    leaves_out=("smoke", "lamps"),
    samples=4,
    filmed=True,
    shows=frozenset({"time", "camera", "picture", "ground", "forest", "fire", "light", "thermal"}),
    needs=("rgb",),
    finish=add_gradient,
)
