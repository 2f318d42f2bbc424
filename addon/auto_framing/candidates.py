"""Candidate cameras: placement around the fire, rating, and descriptions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..run import areas
from .front import MovingFront
from .visible_share import VisibleShare

if TYPE_CHECKING:
    from ..shot.cameras.path import Path
    from ..shot.settings import Camera

LEAST = 0.5  # visible fraction of the front that a camera must reach
ENOUGH = 0.55  # visible fraction at which the search ends
LENS, SENSOR = 28.0, 36.0  # mm, default lens and sensor
FARTHER = (1.0, 2.0, 4.0)  # factors on the distance of a close camera that shows too little
# target height of the front's centre in the picture, and tolerance, in half heights
_FRONT, _ROUND = -0.2, 0.3
_HORIZON, _OFF = 0.75, 0.5  # highest position of the horizon, and penalty for half a height (by eye)
CLEAR = 0.65  # fraction of the front clear of smoke from which the sun and the wind decide (by eye)
VEILED = 0.25  # opacity of smoke near the camera up to which it stays (by eye)
HIDDEN = 0.2  # fraction of the front clear of smoke below which the description warns (by eye)
_SMOKY = 3.0  # weight of smoke before the front and near the camera (by eye)
_BY_NIGHT = 0.7  # of the distance by day of a close camera, as flames are the light (by eye)
_CELLS = 3.0  # fuel cells, least distance of a close camera to its target
INSIDE = 0.95  # of the ground's extent, within which cameras are placed
OVER_CROWNS = 60.0  # m, least height above ground among trees
_SIDES = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PlacedCamera:
    """Placed camera, its visible fraction of the front, and its description."""

    camera: Camera
    share: float
    words: str


class Tried(NamedTuple):
    """Candidate camera, its visible share of the front, and its rating otherwise."""

    seen: VisibleShare
    liking: float
    camera: Camera


def best(tried: list[Tried]) -> Tried:
    """Candidate with the best rating among those that show enough; else the one that shows most.

    Clear views count first: the rating otherwise decides among those with `CLEAR` of the front, or more.
    """
    for least in (ENOUGH, LEAST):
        if good := [candidate for candidate in tried if candidate.seen.share >= least]:
            return max(good, key=_rate)
    return max(tried, key=lambda candidate: candidate.seen.share)


def _rate(candidate: Tried) -> float:
    """Rate a candidate: smoke beyond these limits counts more than wind and sun together."""
    seen = candidate.seen
    return candidate.liking - _SMOKY * (max(1.0 - seen.clear / CLEAR, 0.0) + max(seen.veil - VEILED, 0.0))


def nearest_enough(near: float, tried: Callable[[float], list[Tried]]) -> Tried | None:
    """Best close candidate; farther ones are tried while none shows enough. None if none is over ground.

    Parameters
    ----------
    near
        Least distance, m.
    tried
        Function that makes candidates at a distance (m).
    """
    candidates: list[Tried] = []
    for farther in FARTHER:
        candidates += tried(rounded(farther * near))
        if any(enough(candidate.seen) for candidate in candidates):
            break
    return best(candidates) if candidates else None


def is_over_ground(front: MovingFront, view: Path) -> bool:
    """Return whether a camera and its target stay over the run or the ground around it (`terrain.apron`)."""
    places = np.concatenate([view.position, view.target])[:, :2]  # relative to the run's centre
    reach = INSIDE * front.shot.settings.terrain.apron
    latitude, longitude = front.shot.run.latitude, front.shot.run.longitude
    half = 0.5 * np.array([len(longitude) - 1, len(latitude) - 1]) * areas.cell_size(latitude, longitude)
    return bool(np.all((np.hypot(*places.T) <= reach) | np.all(np.abs(places) <= INSIDE * half, axis=1)))


def away(view: Path) -> float:
    """Horizontal distance (m) of a camera from its target in its first frame."""
    return float(np.hypot(*(view.position - view.target)[0, :2]))


def enough(visible: VisibleShare) -> bool:
    """Return whether a close camera may stay: it shows enough and is not in smoke."""
    return visible.share >= ENOUGH and visible.clear >= CLEAR and visible.veil <= VEILED


def shows(visible: VisibleShare, what: str) -> str:
    """Describe visibility: ``87 % of the front shows, about 60 % clear of smoke``."""
    text = f"{percent(visible.share)} of {what} shows, about {percent(visible.clear)} clear of smoke"
    return text if visible.clear >= HIDDEN else f"{text}: smoke hides most of it from every side"


def near(front: MovingFront, part: float, limits: tuple[float, float], over_crowns: float) -> float:
    """Distance (m) of a close camera: a fraction of one fire's size, within limits.

    By night it is less. It is not below the model's resolution, and among trees not so close that they
    occlude the target.
    """
    distance = min(max(part * front.fire, limits[0]), limits[1]) * (_BY_NIGHT if front.night else 1.0)
    distance = max(distance, _CELLS * max(front.ground.cell), over_crowns if front.crowns else 0.0)
    return rounded(distance)


def liking(front: MovingFront, bearing: float) -> float:
    """Rating of a camera's bearing from the fire (degrees), -1..1; best is windward with the sun behind."""
    side = np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    windward = -float(side @ front.wind)
    azimuth, height = front.sun
    by_day = np.clip(height / 5.0, 0.0, 1.0) * np.cos(np.radians(max(height, 0.0)))
    behind = float(np.cos(np.radians(bearing - azimuth))) * by_day
    weight = np.array([1.0 if np.any(front.wind) else 0.0, 0.6])
    return float(weight @ [windward, behind] / weight.sum())


def bearing(view: Path) -> float:
    """Mean bearing (degrees) of a camera from its target."""
    return float(np.degrees(np.arctan2(*(view.position - view.target)[:, :2].mean(axis=0))))


def framed(visible: VisibleShare) -> float:
    """Framing penalty, 0 or less: front away from its place in the picture, or no horizon."""
    off = max(abs(visible.height - _FRONT) - _ROUND, 0.0)
    return -_OFF * off - _OFF * float(np.clip(visible.horizon - _HORIZON, 0.0, 1.0))


def side(bearing: float) -> str:
    """Compass direction of a bearing: ``south-west``."""
    return _SIDES[round(bearing / 45.0) % 8]


def where(front: MovingFront, bearing: float) -> str:
    """Describe a bearing: ``from the south-west, windward, with the sun behind``."""
    vector = np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    parts = [f"from the {side(bearing)}"]
    if float(vector @ front.wind) < -0.5:
        parts.append("windward")
    azimuth, height = front.sun
    if height > 0.0 and np.cos(np.radians(bearing - azimuth)) > 0.5:
        parts.append("the sun behind it")
    return ", ".join(parts)


def geodetic(front: MovingFront, place: Array) -> tuple[float, float, float]:
    """Latitude, longitude (degrees, to about a metre) and height above ground (m) of a point (3,)."""
    frame, ground = front.ground.frame, front.ground
    latitude, longitude, height = (float(v[0]) for v in frame.reverse(place[None]))
    above = height - float(ground.height(*ground.indices(latitude, longitude)))
    return round(latitude, 5), round((longitude + 180.0) % 360.0 - 180.0, 5), above


def distance(metres: float) -> str:
    """Format a distance: ``3.2 km`` or ``240 m``."""
    return f"{metres / 1e3:.3g} km" if metres >= 1000.0 else f"{metres:.0f} m"


def rounded(metres: float) -> float:
    """Round up to two digits."""
    step = 10.0 ** np.floor(np.log10(max(metres, 1.0)) - 1.0)
    return round(float(np.ceil(round(metres / step, 6)) * step), 6)


def percent(share: float) -> str:
    """Format a fraction: ``87 %``."""
    return f"{100.0 * share:.0f} %"


def path(front: MovingFront, camera: Camera) -> Path:
    """Path of a camera over the bare terrain."""
    return camera.rig.path(camera, front.shot.filming, front.ground)
