"""A camera that stands still and has the whole front in its picture, under its smoke and some sky."""

from __future__ import annotations

import numpy as np

from ..cameras.path import UP, look
from ..cameras.rigs._key import CameraKey
from ..cameras.rigs.drone import Drone
from ..settings.settings import Camera
from . import candidates
from .candidates import Array, Placed, Tried
from .front import Front, some
from .visible_share import Visible, VisibleShare

_LENSES = (
    candidates.LENS,
    20.0,
    14.0,
)  # mm; the next where the fire is too wide for the ground that is drawn
_BEARINGS = np.arange(0.0, 360.0, 22.5)  # degrees
_HEIGHTS = (13.0, 18.0, 25.0, 35.0, 50.0)  # degrees of the camera over the front's middle
_LOW = 0.3  # of the picture's half-height: so far below its middle is that of the front
_ROOM = (0.85, -0.9, 0.35)  # of its half-width and half-height: to both sides, at least and at most up
_PLACES = 400  # of the front that have to be in the picture
_STRAY = 0.02  # of the front may be outside
_NEAREST = 0.7  # of the fire's size, its distance at least: what has burned is around
_LEAST = 0.1  # of the reach of the ground that is drawn
_CROWNS = 4.5  # times OVER_CROWNS, its distance at least where trees stand: so far it sees them from the side
_FARTHEST = 1.0e6  # m
_CLEAR = 0.6  # liking of all the front clear of smoke (by eye)
_STEEP = 0.01  # liking lost for each degree higher than the lowest


def place(front: Front, visible: Visible) -> Placed:
    """The best of directions and heights."""
    points = front.point[some(np.arange(len(front.point)), _PLACES)] if len(front.point) else _whole(front)
    found = []
    for height in _HEIGHTS:
        for bearing in _BEARINGS:
            camera = _camera(front, points, float(bearing), height)
            seen = visible.seen(candidates.path(front, camera))
            likes = candidates.liking(front, float(bearing)) + candidates.framed(seen)
            found.append(Tried(seen, likes - _STEEP * (height - _HEIGHTS[0]), camera))
    seen, _, camera = candidates.best(found, _CLEAR)
    return Placed(camera, seen.share, _words(front, camera, seen))


def _camera(front: Front, points: Array, bearing: float, height: float) -> Camera:
    """In this direction of the points and so many degrees over them, as near as all of them allow."""
    toward, rise = np.radians([bearing, height])
    side = np.array([np.sin(toward), np.cos(toward), 0.0])
    direction = np.cos(rise) * side + np.sin(rise) * UP
    middle = _middle(points, side)
    least = max(_NEAREST * front.size, _CROWNS * candidates.OVER_CROWNS if front.crowns else 0.0)
    lens, half, away = _lens(front, points - middle, direction, least, _room(front, middle, side))
    eye = middle + away * direction
    aim = middle + UP * ((eye - middle)[2] - away * np.cos(rise) * np.tan(rise - _under(half)))
    latitude, longitude, above = candidates.geodetic(front, eye)
    above = candidates.rounded(max(above, candidates.OVER_CROWNS if front.crowns else 2.0))
    aim_latitude, aim_longitude, aim_above = candidates.geodetic(front, aim)
    key = CameraKey(
        0.0, latitude, longitude, above, "point", aim_latitude, aim_longitude, float(round(aim_above))
    )
    return Camera("overview", rig=Drone(focal_length=lens, keys=(key,)))


def _lens(
    front: Front, points: Array, direction: Array, least: float, most: float
) -> tuple[float, Array, float]:
    """Focal length (mm) and tangents of half the angles of view of the longest lens, and its distance (m).

    Parameters
    ----------
    points
        (n, 3) what has to be in the picture, m from the middle of it.
    direction
        (3,) unit vector from there to the camera.
    least, most
        Distances that are allowed, m. Where even the widest lens needs more, it is at `most`.
    """
    aspect = np.divide(*front.shot.settings.render.resolution[::-1])
    for lens in _LENSES:
        half = 0.5 * candidates.SENSOR / lens * np.array([1.0, aspect])
        away = _nearest(points, direction, half, least)
        if away <= most:
            break
    return lens, half, min(away, most)


def _under(half: Array) -> float:
    """Angle (radians) by which the middle of the front is under the middle of the picture."""
    return float(np.arctan(_LOW * half[1]))


def _nearest(points: Array, direction: Array, half: Array, least: float) -> float:
    """Distance (m), at least `least`, from which a camera in a direction has all points in its picture."""
    flat = np.array([*direction[:2], 0.0])
    tilt = np.arcsin(direction[2]) - _under(half)
    rotation = look(np.zeros((1, 3)), (-flat - np.linalg.norm(flat) * np.tan(tilt) * UP)[None])[0]
    low, high = least, least
    while not _fits(points, high * direction, rotation, half) and high < _FARTHEST:
        low, high = high, 1.5 * high
    while high - low > 0.01 * high:
        away = 0.5 * (low + high)
        low, high = (low, away) if _fits(points, away * direction, rotation, half) else (away, high)
    return high


def _fits(points: Array, eye: Array, rotation: Array, half: Array) -> bool:
    """Whether all but a few of the points are in the part of the picture that is for the front."""
    right, above, back = ((points - eye) @ rotation).T
    ahead = np.maximum(-back, 1.0e-6)
    x, y = right / ahead / half[0], above / ahead / half[1]
    sides, lowest, highest = _ROOM
    outside = (back >= 0.0) | (np.abs(x) > sides) | (y < lowest) | (y > highest)
    return float(np.mean(outside)) <= _STRAY


def _middle(points: Array, side: Array) -> Array:
    """Middle (3,) of the points between their ends along and across a direction, at their mean height."""
    across = np.array([-side[1], side[0], 0.0])
    ends = [np.percentile(points @ axis, [1.0, 99.0]).mean() * axis for axis in (side, across)]
    return ends[0] + ends[1] + np.array([0.0, 0.0, float(points[:, 2].mean())])


def _room(front: Front, middle: Array, side: Array) -> float:
    """How far (m) from the middle a camera may stand on that side: where the ground that is drawn ends."""
    reach = 0.95 * front.shot.settings.terrain.apron
    here = middle[:2]  # from the middle of the run, where the scene's origin is
    along = float(here @ side[:2])
    beside = max(along**2 - float(here @ here) + reach**2, 0.0)
    return max(-along + float(np.sqrt(beside)), _LEAST * reach)


def _whole(front: Front) -> Array:
    """Corners (4, 3) of the run's ground, where nothing burns."""
    x, y = np.meshgrid(*np.stack([front.low, front.high], axis=-1))
    return np.stack([x.ravel(), y.ravel(), front.ground.up(x.ravel(), y.ravel())], axis=-1)


def _words(front: Front, camera: Camera, seen: VisibleShare) -> str:
    """A line about the camera."""
    (key,) = camera.rig.keys
    view = candidates.path(front, camera)
    side = candidates.where(front, candidates.bearing(view))
    text = f"{side}: {candidates.distance(candidates.away(view))} away, {key.height:,.0f} m up"
    if not len(front.point):
        return f"{text}; nothing burns in the run"
    return f"{text}; {candidates.shows(seen, 'the front')}"
