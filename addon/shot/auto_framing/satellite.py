"""A view straight down on all that has burned."""

from __future__ import annotations

import numpy as np

from ..cameras.rigs._key import CameraKey
from ..cameras.rigs.satellite import Satellite
from ..settings.settings import Camera
from . import candidates
from .candidates import Placed
from .front import Front
from .visible_share import Visible

_MORE = 1.7  # of what has burned, across the picture: some country round it
_LEE = 0.12  # of its width and height: so far its middle is to leeward, for smoke
_LEAST = 400.0  # m


def place(front: Front, visible: Visible) -> Placed:
    """Over what has burned by the end of the window, and some of its smoke."""
    width, height = front.high - front.low
    across, up = front.shot.settings.render.resolution
    swath = candidates.rounded(max(_MORE * width, _MORE * height * across / up, _LEAST))
    lee = _LEE * swath * np.array([1.0, up / across]) * front.wind
    middle = np.array([*0.5 * (front.low + front.high) + lee, 0.0])
    latitude, longitude, _ = candidates.geodetic(front, middle)
    rig = Satellite(swath=swath, keys=(CameraKey(0.0, latitude, longitude),))
    camera = Camera("satellite", rig=rig)
    seen = visible.seen(candidates.path(front, camera))
    words = f"from above, {candidates.distance(swath)} wide"
    if len(front.point):
        words += f"; {candidates.percent(seen.share)} of the front is in it, smoke aside"
    return Placed(camera, seen.share, words)
