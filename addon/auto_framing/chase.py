"""Chase camera of auto framing: moves with the head of the fire."""

from __future__ import annotations

from dataclasses import replace

from ..shot.cameras.rigs.chase import Chase
from ..shot.settings import Camera
from . import candidates, flank
from .candidates import PlacedCamera, Tried
from .front import MovingFront
from .visible_share import Visible

_PART = 1.0 / 12.0  # of the fire's size: 2.4 km at 29 km, as the example's drone (by eye)
_DISTANCES = (80.0, 3000.0)  # m
_OVER_CROWNS = 180.0  # m, among trees; a nearer camera looks only down on them
# degrees from the head's course, best first
_SIDES = (150.0, 210.0, 120.0, 240.0, 180.0, 90.0, 270.0, 50.0, 310.0)
_HEIGHTS = (0.3, 0.6, 1.1, 1.7)  # of the distance
_AIM = 0.12  # of the distance, height of the aim above ground: flames below the centre, smoke above
_LATER = 0.01  # penalty for each later side or height


def place(front: MovingFront, visible: Visible) -> PlacedCamera | None:
    """Best candidate over sides and heights; farther ones while no near one shows enough.

    If smoke hides the head from every side, the camera stays and looks at a flank from twice the distance.
    None if no candidate is over ground.
    """
    near = candidates.near(front, _PART, _DISTANCES, _OVER_CROWNS)
    best = candidates.nearest_enough(near, lambda distance: _tried(front, visible, distance))
    if best is None:
        return None
    text, of = "goes along with the head", "the head"
    if best.seen.clear < candidates.HIDDEN:
        aside = candidates.nearest_enough(2.0 * near, lambda distance: flank.tried(front, visible, distance))
        if aside is not None and aside.seen.clear > best.seen.clear:
            best, of = aside._replace(camera=replace(aside.camera, name="chase")), "its aim"
            text = "looks at a flank, as smoke hides the head from every side"
    view = candidates.path(front, best.camera)
    away = candidates.distance(candidates.away(view))
    above = float((view.position[0, 2] - front.ground.up(*view.position[:1, :2].T))[0])
    words = (
        f"{text}, {candidates.where(front, candidates.bearing(view))}: {away} away, {above:,.0f} m up; "
        + candidates.shows(best.seen, f"the front within {away} of {of}")
    )
    return PlacedCamera(best.camera, best.seen.share, words)


def _tried(front: MovingFront, visible: Visible, distance: float) -> list[Tried]:
    """Candidates at a distance from the head, with the visible share of the front that near to it."""
    tried = []
    for number, (height, side) in enumerate((height, side) for height in _HEIGHTS for side in _SIDES):
        above = candidates.rounded(max(height * distance, candidates.OVER_CROWNS if front.crowns else 0.0))
        aim, clearance = candidates.rounded(_AIM * distance), min(50.0, 0.5 * above)
        rig = Chase(distance=distance, side=side, height=above, target_height=aim, clearance=clearance)
        camera = Camera("chase", rig=rig)
        view = candidates.path(front, camera)
        if not candidates.is_over_ground(front, view):
            continue
        share = visible.seen(view, distance)
        likes = (
            candidates.liking(front, candidates.bearing(view)) + candidates.framed(share) - _LATER * number
        )
        tried.append(Tried(share, likes, camera))
    return tried
