"""A camera close to a flank of the fire, low over ground that has not burned."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..cameras.rigs._key import CameraKey
from ..cameras.rigs.drone import Drone
from ..settings.settings import Camera
from . import candidates
from .candidates import Placed, Tried
from .front import Front, some
from .visible_share import Visible

_PART = 1.0 / 40.0  # of the fire's size (by eye)
_DISTANCES = (45.0, 700.0)  # m
_OVER_CROWNS = 250.0  # m, where trees stand: nearer and lower they hide the flames
_PLACES = 8  # of the flanks that are tried
_TURNS = (0.0, 40.0, -40.0)  # degrees from straight before the flank
_HEIGHTS = (0.25, 0.4, 0.6)  # of the distance
_AIM = 0.08  # of the distance above the ground: flames below the middle, smoke above it
_STEEP = 0.1  # liking lost for each higher step


def place(front: Front, visible: Visible) -> Placed:
    """The best of places, directions and heights; of farther ones where no near one shows enough."""
    near = candidates.near(front, _PART, _DISTANCES, _OVER_CROWNS)
    best = candidates.nearest_enough(near, lambda distance: _tried(front, visible, near, distance))
    view = candidates.path(front, best.camera)
    words = (
        f"close to a flank, {candidates.where(front, candidates.bearing(view))}: "
        f"{candidates.distance(candidates.away(view))} away, {best.camera.rig.keys[0].height:,.0f} m up; "
        + candidates.shows(best.seen, f"the front within {candidates.distance(near)} of its aim")
    )
    return Placed(best.camera, best.seen.share, words)


def _tried(front: Front, visible: Visible, near: float, distance: float) -> list[Tried]:
    """Cameras so far from flanks, with what they show of the front within `near` m of what they look at."""
    found = []
    for at in _flanks(front):
        for number, height in enumerate(_HEIGHTS):
            for turn in _TURNS:
                camera, bearing = _camera(front, int(at), distance, height, turn)
                seen = visible.seen(candidates.path(front, camera), near)
                likes = candidates.liking(front, bearing) + candidates.framed(seen) - _STEEP * number
                found.append(Tried(seen, likes, camera))
    return found


def _flanks(front: Front) -> NDArray[np.int64]:
    """Places of the front in the middle of the window that run across the fire's course, far from each other.

    Where the fire has no course, any.
    """
    middle = np.flatnonzero(front.moment == front.moment[len(front.moment) // 2])
    speed = np.maximum(np.hypot(*front.velocity[middle].T), 1.0e-9)
    course = front.heading if np.any(front.heading) else front.wind
    across = 1.0 - np.abs(front.velocity[middle] @ course) / speed
    good = middle[across >= np.quantile(across, 0.6)]
    order = good[np.argsort(front.point[good] @ np.array([*course, 0.0]) if np.any(course) else good)]
    return some(order, _PLACES)


def _camera(front: Front, at: int, distance: float, height: float, turn: float) -> tuple[Camera, float]:
    """Before a place of the front, looking at it, with its bearing from there (degrees)."""
    bearing = float(np.degrees(np.arctan2(*front.velocity[at]))) + turn
    toward = np.radians(bearing)
    eye = front.point[at] + distance * np.array([np.sin(toward), np.cos(toward), 0.0])
    latitude, longitude, _ = candidates.geodetic(front, eye)
    aim_latitude, aim_longitude, _ = candidates.geodetic(front, front.point[at])
    above = candidates.rounded(max(height * distance, candidates.OVER_CROWNS if front.crowns else 6.0))
    aim = candidates.rounded(_AIM * distance)
    key = CameraKey(0.0, latitude, longitude, above, "point", aim_latitude, aim_longitude, aim)
    return Camera("flank", rig=Drone(clearance=min(10.0, 0.5 * above), keys=(key,))), bearing
