"""Thermal view of the FIRETWIN paper: the model's mean air temperature in colour over the visible picture.

The run's `temperature` is averaged over ten minutes, or over the frame step if that is longer. The gradient
black, purple, red, orange, yellow, white shows its excess over unburned air of equal elevation
(`air_temperature.warmth`). The paper does not define where its gradient begins. Over the whole field,
cold ridges and warm valleys would take most of it and redden all unburned ground. Black is the excess that
one percent of unburned cells exceed. White is the warmest of the shot, so colours mean the same in every
frame. The colour of the visible ground, from depth, is added to the picture's pixels (0..1) and clamped at 1.
It is the model's air, not what an infrared camera measures.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import DerivedPass, Files

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Add the gradient of the model's temperature to the picture."""
    import numpy as np
    from firetwin_core import sensor
    from firetwin_core.terrain import bilinear

    from ..cameras import pixel_rays
    from ..fire import air_temperature

    now = float(shot.frames.time(frame))
    above, _ = air_temperature.warmth(shot.run, now - shot.air.averaged, now)
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    point = pixel_rays.points(pixel_rays.path_of(shot, camera), frame, planar)
    ground = np.isfinite(point).all(axis=-1)
    warmth = np.full(planar.shape, np.nan)
    if ground.any():
        latitude, longitude, _ = shot.local_frame.reverse(point[ground])
        warmth[ground] = bilinear(above, *air_temperature.indices(shot.run, latitude, longitude))
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    sensor.write_image(files["png"], sensor.thermal_composite(rgb, warmth, *shot.air.warmest))


PASS = DerivedPass(
    name="thermal_map",
    order=35,
    help="Visible picture with the model's mean temperature added in colour",
    files=("png",),
    film=True,
    aspects=frozenset({"time", "camera"}),
    needs=("rgb", "depth"),
    finish=finish,
)
