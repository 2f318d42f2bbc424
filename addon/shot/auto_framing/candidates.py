"""What the fitted cameras share: how they are placed round the fire, and what is said of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import sun
from .front import Front
from .visible_share import VisibleShare

if TYPE_CHECKING:
    from ..cameras.path import Path
    from ..settings.settings import Camera

LEAST = 0.5  # of the front that a camera has to show
ENOUGH = 0.55  # as much is looked for
LENS, SENSOR = 28.0, 36.0  # mm, of cameras unless more has to be in the picture
FARTHER = (1.0, 1.6, 2.5, 4.0)  # times its distance: where a close camera that shows too little moves to
_FRONT, _ROUND = -0.2, 0.3  # where its middle is to be, and how far off it may, in halves of the height
_HORIZON, _OFF = 0.75, 0.5  # where the horizon is at most, and liking lost for half the height (by eye)
_SOME = 0.65  # of the front is clear of smoke, by straight plumes, where a close camera stays (by eye)
CLOSE_CLEAR = 3.0  # liking of all the front clear of smoke, of close cameras: they could stand in it (by eye)
_CELLS = 3.0  # of the fuel grid, at least from a close camera to what it films
OVER_CROWNS = 60.0  # m above the ground at least where trees stand
_SIDES = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Placed:
    """A camera, the share of the front that it shows, and a line about it."""

    camera: Camera
    share: float
    words: str


class Tried(NamedTuple):
    """A camera, what it shows of the front, and how well it stands otherwise."""

    seen: VisibleShare
    liking: float
    camera: Camera


def best(found: list[Tried], clear: float) -> Tried:
    """The one that is liked most of those that show enough; where none does, the one that shows most.

    Parameters
    ----------
    clear
        Liking of all the front clear of smoke.
    """
    for least in (ENOUGH, LEAST):
        if good := [each for each in found if each.seen.share >= least]:
            return max(good, key=lambda each: clear * each.seen.clear + each.liking)
    return max(found, key=lambda each: each.seen.share)


def nearest_enough(near: float, tried: Callable[[float], list[Tried]]) -> Tried:
    """The best of close cameras; of farther ones as well, where no nearer one shows enough.

    Parameters
    ----------
    near
        The least distance, m.
    tried
        Gives the cameras of a distance (m).
    """
    found: list[Tried] = []
    for farther in FARTHER:
        found += tried(rounded(farther * near))
        if any(enough(each.seen) for each in found):
            break
    return best(found, CLOSE_CLEAR)


def away(view: Path) -> float:
    """How far (m) a camera is from what it looks at in its first frame, over the ground."""
    return float(np.hypot(*(view.position - view.target)[0, :2]))


def enough(seen: VisibleShare) -> bool:
    """Whether a close camera need not move off: it shows enough, and does not stand in smoke."""
    return seen.share >= ENOUGH and seen.clear >= _SOME


def shows(seen: VisibleShare, what: str) -> str:
    """``87 % of the front shows, about 60 % clear of smoke``."""
    return f"{percent(seen.share)} of {what} shows, about {percent(seen.clear)} clear of smoke"


def near(front: Front, part: float, limits: tuple[float, float], over_crowns: float) -> float:
    """How far (m) a close camera is from what it films: a part of one fire's size, within limits.

    Not so near that the model knows nothing as fine, and where trees stand, not so near that they hide it.
    """
    distance = min(max(part * front.fire, limits[0]), limits[1])
    distance = max(distance, _CELLS * max(front.ground.cell), over_crowns if front.crowns else 0.0)
    return rounded(distance)


def liking(front: Front, bearing: float) -> float:
    """How well a camera stands in a direction of the fire (degrees), -1..1: windward, the sun behind it."""
    side = np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    windward = -float(side @ front.wind)
    azimuth, height = sun.position(front.shot.run, front.shot.frames.middle)
    by_day = np.clip(height / 5.0, 0.0, 1.0) * np.cos(np.radians(max(height, 0.0)))
    behind = float(np.cos(np.radians(bearing - azimuth))) * by_day
    weight = np.array([1.0 if np.any(front.wind) else 0.0, 0.6])
    return float(weight @ [windward, behind] / weight.sum())


def bearing(view: Path) -> float:
    """Direction (degrees) that a camera mostly stands in, seen from what it looks at."""
    return float(np.degrees(np.arctan2(*(view.position - view.target)[:, :2].mean(axis=0))))


def framed(seen: VisibleShare) -> float:
    """Liking lost, 0 or less, where the front is far from its place in the picture, or no horizon in it."""
    off = max(abs(seen.height - _FRONT) - _ROUND, 0.0)
    return -_OFF * off - _OFF * float(np.clip(seen.horizon - _HORIZON, 0.0, 1.0))


def side(bearing: float) -> str:
    """A direction in words: ``south-west``."""
    return _SIDES[round(bearing / 45.0) % 8]


def where(front: Front, bearing: float) -> str:
    """``from the south-west, windward, with the sun behind``."""
    vector = np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    found = [f"from the {side(bearing)}"]
    if float(vector @ front.wind) < -0.5:
        found.append("windward")
    azimuth, height = sun.position(front.shot.run, front.shot.frames.middle)
    if height > 0.0 and np.cos(np.radians(bearing - azimuth)) > 0.5:
        found.append("the sun behind it")
    return ", ".join(found)


def geodetic(front: Front, place: Array) -> tuple[float, float, float]:
    """Latitude, longitude (degrees, to about a metre) and height above the ground (m) of a place (3,)."""
    frame, ground = front.ground.frame, front.ground
    latitude, longitude, height = (float(v[0]) for v in frame.reverse(place[None]))
    above = height - float(ground.height(*ground.indices(latitude, longitude)))
    return round(latitude, 5), round((longitude + 180.0) % 360.0 - 180.0, 5), above


def distance(metres: float) -> str:
    """``3.2 km`` or ``240 m``."""
    return f"{metres / 1e3:.3g} km" if metres >= 1000.0 else f"{metres:.0f} m"


def rounded(metres: float) -> float:
    """To two digits, upward."""
    step = 10.0 ** np.floor(np.log10(max(metres, 1.0)) - 1.0)
    return round(float(np.ceil(round(metres / step, 6)) * step), 6)


def percent(share: float) -> str:
    """``87 %``."""
    return f"{100.0 * share:.0f} %"


def path(front: Front, camera: Camera) -> Path:
    """The way of a camera over the bare ground."""
    return camera.rig.path(camera, front.shot, front.ground)
