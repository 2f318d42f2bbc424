"""Flank camera of auto framing: close to a flank of the fire, low above unburned ground."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..shot.cameras.rigs._key import CameraKey
from ..shot.cameras.rigs.drone import Drone
from ..shot.settings import Camera
from . import candidates
from .candidates import PlacedCamera, Tried
from .front import MovingFront, some
from .visible_share import Visible

_PART = 1.0 / 40.0  # of the fire's size (by eye)
_DISTANCES = (45.0, 700.0)  # m
_OVER_CROWNS = 250.0  # m, among trees; nearer and lower they occlude the flames
_PLACES = 6  # points of the flanks that are tried
_TURNS = (0.0, 40.0, -40.0)  # degrees from the flank's normal
_HEIGHTS = (0.25, 0.45, 0.9)  # of the distance
_AIM = 0.08  # of the distance, height of the aim above ground: flames below the centre, smoke above
_STEEP = 0.1  # penalty for each higher step


def place(front: MovingFront, visible: Visible) -> PlacedCamera | None:
    """Best candidate over points, directions and heights; farther ones while no near one shows enough.

    None if no candidate is over ground.
    """
    near = candidates.near(front, _PART, _DISTANCES, _OVER_CROWNS)
    best = candidates.nearest_enough(near, lambda distance: tried(front, visible, distance))
    if best is None:
        return None
    view = candidates.path(front, best.camera)
    words = (
        f"close to a flank, {candidates.where(front, candidates.bearing(view))}: "
        f"{candidates.distance(candidates.away(view))} away, {best.camera.rig.keys[0].height:,.0f} m up; "
        + candidates.shows(
            best.seen, f"the front within {candidates.distance(candidates.away(view))} of its aim"
        )
    )
    return PlacedCamera(best.camera, best.seen.share, words)


def tried(front: MovingFront, visible: Visible, distance: float) -> list[Tried]:
    """Candidates at a distance from flanks, with the visible share of the front that near to the aim."""
    trials = []
    for at in _flanks(front):
        for number, height in enumerate(_HEIGHTS):
            for turn in _TURNS:
                camera, bearing = _camera(front, int(at), distance, height, turn)
                view = candidates.path(front, camera)
                if not candidates.is_over_ground(front, view):
                    continue
                share = visible.seen(view, distance)
                likes = candidates.liking(front, bearing) + candidates.framed(share) - _STEEP * number
                trials.append(Tried(share, likes, camera))
    return trials


def _flanks(front: MovingFront) -> NDArray[np.int64]:
    """Points on the flanks in the middle of the window: front parallel to the fire's course, far apart.

    Any points of the front if the fire has no course.
    """
    middle = np.flatnonzero(front.moment == front.moment[len(front.moment) // 2])
    speed = np.maximum(np.hypot(*front.velocity[middle].T), 1.0e-9)
    course = front.heading if np.any(front.heading) else front.wind
    across = 1.0 - np.abs(front.velocity[middle] @ course) / speed
    good = middle[across >= np.quantile(across, 0.6)]
    order = good[np.argsort(front.point[good] @ np.array([*course, 0.0]) if np.any(course) else good)]
    return some(order, _PLACES)


def _camera(front: MovingFront, at: int, distance: float, height: float, turn: float) -> tuple[Camera, float]:
    """Camera in front of a front point, looking at it, and its bearing from there (degrees)."""
    bearing = float(np.degrees(np.arctan2(*front.velocity[at]))) + turn
    toward = np.radians(bearing)
    eye = front.point[at] + distance * np.array([np.sin(toward), np.cos(toward), 0.0])
    latitude, longitude, _ = candidates.geodetic(front, eye)
    aim_latitude, aim_longitude, _ = candidates.geodetic(front, front.point[at])
    above = candidates.rounded(max(height * distance, candidates.OVER_CROWNS if front.crowns else 6.0))
    aim = candidates.rounded(_AIM * distance)
    key = CameraKey(0.0, latitude, longitude, above, "point", aim_latitude, aim_longitude, aim)
    return Camera("flank", rig=Drone(clearance=min(10.0, 0.5 * above), keys=(key,))), bearing
