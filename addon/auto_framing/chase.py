"""Chase camera of auto framing: moves with the head of the fire."""

from __future__ import annotations

from ..shot.cameras.rigs.chase import Chase
from ..shot.settings import Camera
from . import candidates
from .candidates import PlacedCamera, Tried
from .front import Front
from .visible_share import Visible

_PART = 1.0 / 12.0  # of the fire's size: 2.4 km at 29 km, as the example's drone (by eye)
_DISTANCES = (80.0, 3000.0)  # m
_OVER_CROWNS = 180.0  # m, among trees; a nearer camera looks only down on them
# degrees from the head's course, best first
_SIDES = (150.0, 210.0, 120.0, 240.0, 180.0, 90.0, 270.0, 50.0, 310.0)
_HEIGHTS = (0.3, 0.6, 1.1, 1.7)  # of the distance
_AIM = 0.12  # of the distance, height of the aim above ground: flames below the centre, smoke above
_LATER = 0.04  # penalty for each later side or height


def place(front: Front, visible: Visible) -> PlacedCamera:
    """Best candidate over sides and heights; farther ones while no near one shows enough."""
    near = candidates.near(front, _PART, _DISTANCES, _OVER_CROWNS)
    best = candidates.nearest_enough(near, lambda distance: _tried(front, visible, near, distance))
    way = candidates.bearing(candidates.path(front, best.camera))
    words = (
        f"goes along with the head, {candidates.where(front, way)}: "
        f"{candidates.distance(best.camera.rig.distance)} away, {best.camera.rig.height:,.0f} m up; "
        + candidates.shows(best.seen, f"the front within {candidates.distance(near)} of the head")
    )
    return PlacedCamera(best.camera, best.seen.share, words)


def _tried(front: Front, visible: Visible, near: float, distance: float) -> list[Tried]:
    """Candidates at a distance from the head, with the visible share of the front within `near` m of it."""
    tried = []
    for number, (height, side) in enumerate((height, side) for height in _HEIGHTS for side in _SIDES):
        above = candidates.rounded(max(height * distance, candidates.OVER_CROWNS if front.crowns else 0.0))
        aim, clearance = candidates.rounded(_AIM * distance), min(50.0, 0.5 * above)
        rig = Chase(distance=distance, side=side, height=above, target_height=aim, clearance=clearance)
        camera = Camera("chase", rig=rig)
        view = candidates.path(front, camera)
        share = visible.seen(view, near)
        likes = (
            candidates.liking(front, candidates.bearing(view)) + candidates.framed(share) - _LATER * number
        )
        tried.append(Tried(share, likes, camera))
    return tried
