"""Overlay of the model's mean near-surface air temperature in colour, as in the FIRETWIN paper.

The run's `temperature` is averaged over ten minutes, or over the frame step if that is longer. The gradient
black, purple, red, orange, yellow, white shows its excess over unburned air of equal elevation
(`air_temperature.warmth`). The paper does not define the lower limit of its gradient. Over the complete
field, cold ridges and warm valleys would take most of it and redden all unburned ground. Black is the excess
that one percent of unburned cells exceed. White is the warmest of the shot, so colours mean the same in every
frame. The colour of the visible ground, from depth, is added to the picture's pixels (0..1) and clamped at 1.
It shows the air temperature of the model, not the measurement of an infrared camera.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor
from firetwin_core.terrain import bilinear

from ..shot.cameras import pixel_rays
from ..shot.fire import air_temperature
from ..shot.passes import DerivedPass, Files
from ..shot.shot import Shot

ORDER = 35
HELP = "Visible picture with the model's mean near-surface air temperature added in colour"

PASS = DerivedPass(
    files=("png",),
    film=True,
    aspects=frozenset({"time", "camera"}),
    needs=("rgb", "depth"),
)


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Add the gradient of the model's temperature to the picture."""
    now = float(shot.frames.time(frame))
    above, _ = air_temperature.warmth(shot.run, now - shot.air.averaged, now)
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    point = pixel_rays.points(pixel_rays.path_of(shot.paths, camera), frame, planar)
    ground = np.isfinite(point).all(axis=-1)
    warmth = np.full(planar.shape, np.nan)
    if ground.any():
        latitude, longitude, _ = shot.local_frame.reverse(point[ground])
        warmth[ground] = bilinear(above, *air_temperature.indices(shot.run, latitude, longitude))
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    sensor.write_image(files["png"], sensor.thermal_composite(rgb, warmth, *shot.air.warmest))
