"""A view straight down on all that has burned."""

from __future__ import annotations

import numpy as np

from ..rigs._key import CameraKey
from ..rigs.satellite import Satellite
from ..settings import Camera
from . import placing
from .front import Front
from .placing import Placed
from .visible import Visible

_MORE = 1.5  # of what has burned, across the picture: some country round it
_LEAST = 400.0  # m


def place(front: Front, visible: Visible) -> Placed:
    """Over the middle of what has burned by the end of the window."""
    width, height = front.high - front.low
    across, up = front.shot.settings.render.resolution
    swath = placing.rounded(max(_MORE * width, _MORE * height * across / up, _LEAST))
    middle = np.array([*0.5 * (front.low + front.high), 0.0])
    latitude, longitude, _ = placing.geodetic(front, middle)
    last = str(front.shot.frames.count)
    rig = Satellite(swath=swath, keys=(CameraKey(0.0, latitude, longitude),))
    camera = Camera("satellite", rig=rig, passes=("rgb", "thermal"), frames=last)
    share = visible.share(placing.path(front, camera))
    words = f"from above, {placing.distance(swath)} wide, once, at the end"
    if len(front.point):
        words += f"; {placing.percent(share)} of the front is in the picture (smoke over it is not counted)"
    return Placed(camera, share, words)
