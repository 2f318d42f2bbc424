"""Satellite view of auto framing: nadir view of the burned area."""

from __future__ import annotations

import numpy as np

from ..shot.cameras.rigs._key import CameraKey
from ..shot.cameras.rigs.satellite import Satellite
from ..shot.settings import Camera
from . import candidates
from .candidates import PlacedCamera
from .front import MovingFront
from .visible_share import Visible

_MORE = 2.2  # swath relative to the fire, which is in the middle; the margin shows some of its smoke
_LEAST = 400.0  # m


def place(front: MovingFront, visible: Visible) -> PlacedCamera:
    """View of the fire by the end of the window, in the middle of the picture."""
    width, height = front.high - front.low
    across, up = front.shot.settings.render.resolution
    swath = candidates.rounded(max(_MORE * width, _MORE * height * across / up, _LEAST))
    middle = np.array([*0.5 * (front.low + front.high), 0.0])
    latitude, longitude, _ = candidates.geodetic(front, middle)
    rig = Satellite(swath=swath, keys=(CameraKey(0.0, latitude, longitude),))
    camera = Camera("satellite", rig=rig)
    share = visible.seen(candidates.path(front, camera))
    words = f"from above, {candidates.distance(swath)} wide"
    if len(front.point):
        words += f"; {candidates.percent(share.share)} of the front is in it, smoke aside"
    return PlacedCamera(camera, share.share, words)
