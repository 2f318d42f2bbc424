"""The FIRETWIN paper's thermal view: colours of the model's mean temperature added to the visible picture.

The run's `temperature` is averaged over ten minutes, or the time between two frames where that is longer. The
gradient black, purple, red, orange, yellow, white shows how much warmer that air is than unburned air as
high (`shot.air_temperature.warmth`): the paper does not say where its gradient begins, and over the whole
field cold ridges and warm valleys would take up most of it, and redden all that does not burn. Black is what
a hundredth of the unburned cells are above, white the warmest of the shot, so that colours mean the same in
every frame. The colour where the ground is seen, by the depth, is added to the picture's pixels (0..1) and
held at 1. It is the model's air, not what an infrared camera sees.
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

    from .. import air_temperature
    from ..cameras import pixel_rays

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
