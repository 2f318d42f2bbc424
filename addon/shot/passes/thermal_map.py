"""The FIRETWIN paper's thermal view: colours of the model's mean temperature added to the visible picture.

The run's `temperature` is averaged over ten minutes, or the time between two frames where that is longer. The
gradient black, purple, red, orange, yellow, white goes from the lowest to the highest of it in the middle of
the shot, so that colours mean the same in every frame. Its colour where the ground is seen, by the depth, is
added to the picture's pixels (0..1) and held at 1. It is the model's air, not what an infrared camera sees.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import Files, Pass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot

LEAST = 600.0  # s


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Add the gradient of the model's temperature to the picture."""
    import numpy as np
    from firetwin_core import sensor

    from .. import temperature
    from ..ground import bilinear
    from . import _view

    span = max(LEAST, shot.frames.step)

    def mean(time: float) -> np.ndarray:
        return temperature.mean(shot.run, time - span, time)

    middle, now = mean(shot.frames.middle), mean(float(shot.frames.time(frame)))
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    point = _view.points(_view.of(shot, camera), frame, planar)
    ground = np.isfinite(point).all(axis=-1)
    kelvin = np.full(planar.shape, np.nan)
    if ground.any():
        latitude, longitude, _ = shot.local_frame.reverse(point[ground])
        kelvin[ground] = bilinear(now, *temperature.indices(shot.run, latitude, longitude))
    low, high = float(middle.min()), float(middle.max())
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    sensor.write_image(files["png"], sensor.thermal_composite(rgb, kelvin, low, max(high, low + 1.0)))


PASS = Pass(
    name="thermal_map",
    order=35,
    help="The picture with colours of the model's mean temperature added",
    files=("png",),
    output="",
    filmed=True,
    shows=frozenset({"time", "camera"}),
    needs=("rgb", "depth"),
    finish=finish,
)
