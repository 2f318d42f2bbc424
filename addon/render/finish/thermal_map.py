"""Add the model's mean temperature, in colour, to the visible picture."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor
from firetwin_core.terrain import bilinear

from ...shot.cameras import pixel_rays
from ...shot.fire import air_temperature
from ...shot.shot import Shot
from . import Files


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
