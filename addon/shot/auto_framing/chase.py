"""A camera that goes along with the head of the fire."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..cameras.rigs.chase import Chase
from ..settings.settings import Camera
from . import candidates
from .candidates import Placed, Tried
from .front import Front
from .visible_share import Visible

if TYPE_CHECKING:
    from ..cameras.path import Path

_PART = 1.0 / 12.0  # of the fire's size: 2.4 km at 29 km, as of the example's drone (by eye)
_DISTANCES = (80.0, 3000.0)  # m
_OVER_CROWNS = 180.0  # m, where trees stand: nearer one only looks down on them
_SIDES = (150.0, 210.0, 120.0, 240.0, 180.0, 90.0, 270.0)  # degrees from the head's course, best first
_HEIGHTS = (0.3, 0.45, 0.7, 1.1)  # of the distance
_AIM = 0.12  # of the distance above the ground: flames below the middle, smoke above it
_LATER = 0.04  # liking lost for each later side or height
_OVER_SCAR = 0.7  # part of the clear view lost over burned ground: smoke of both flanks meets there (by eye)


def place(front: Front, visible: Visible) -> Placed:
    """The best of sides and heights; of farther ones where no near one shows enough."""
    near = candidates.near(front, _PART, _DISTANCES, _OVER_CROWNS)
    best = candidates.nearest_enough(near, lambda distance: _tried(front, visible, near, distance))
    way = candidates.bearing(candidates.path(front, best.camera))
    words = (
        f"goes along with the head, {candidates.where(front, way)}: "
        f"{candidates.distance(best.camera.rig.distance)} away, {best.camera.rig.height:,.0f} m up; "
        + candidates.shows(best.seen, f"the front within {candidates.distance(near)} of the head")
    )
    return Placed(best.camera, best.seen.share, words)


def _tried(front: Front, visible: Visible, near: float, distance: float) -> list[Tried]:
    """Cameras so far from the head, with what they show of the front within `near` m of it."""
    found = []
    for number, (height, side) in enumerate((height, side) for height in _HEIGHTS for side in _SIDES):
        above = candidates.rounded(max(height * distance, candidates.OVER_CROWNS if front.crowns else 0.0))
        aim, clearance = candidates.rounded(_AIM * distance), min(50.0, 0.5 * above)
        rig = Chase(distance=distance, side=side, height=above, target_height=aim, clearance=clearance)
        camera = Camera("chase", rig=rig)
        view = candidates.path(front, camera)
        seen = visible.seen(view, near)
        seen = seen._replace(clear=seen.clear * (1.0 - _OVER_SCAR * _over_scar(front, view)))
        likes = candidates.liking(front, candidates.bearing(view)) + candidates.framed(seen) - _LATER * number
        found.append(Tried(seen, likes, camera))
    return found


def _over_scar(front: Front, view: Path) -> float:
    """Part of the front's moments at which a camera is over ground that has burned by then."""
    ground, times = front.ground, front.shot.frames.times
    latitude, longitude, _ = ground.frame.reverse(view.position[front.frames])
    arrival = ground.arrival_at(*ground.indices(latitude, longitude))
    return float(np.mean(arrival <= times[front.frames]))
