"""Overview camera of auto framing: static, with the whole front below its smoke and some sky."""

from __future__ import annotations

import numpy as np

from ..shot.cameras.path import UP, look
from ..shot.cameras.rigs._key import CameraKey
from ..shot.cameras.rigs.drone import Drone
from ..shot.settings import Camera
from . import candidates
from .candidates import Array, PlacedCamera, Tried
from .front import MovingFront, some
from .visible_share import Visible, VisibleShare

_LENSES = (
    candidates.LENS,
    20.0,
    14.0,
)  # mm; the next where the fire is too wide for the ground that is drawn
_BEARINGS = np.arange(0.0, 360.0, 22.5)  # degrees
_HEIGHTS = (13.0, 18.0, 25.0, 35.0, 50.0)  # degrees of elevation above the front's centre
_LOW = 0.3  # half heights; position of the front below the picture's centre
_ROOM = (0.85, -0.9, 0.35)  # half widths and half heights: limits to both sides, below and above
_PLACES = 400  # front points that must be in the picture
_STRAY = 0.02  # fraction of the front that may be outside
_NEAREST = 0.7  # of the fire's size, least distance: burned ground surrounds the front
_LEAST = 0.1  # of the terrain's extent
_CROWNS = 4.5  # times OVER_CROWNS, least distance among trees, for a side view of them
_FARTHEST = 1.0e6  # m
_STEEP = 0.01  # penalty for each degree above the lowest


def place(front: MovingFront, visible: Visible) -> PlacedCamera:
    """Best candidate over directions and heights."""
    points = front.point[some(np.arange(len(front.point)), _PLACES)] if len(front.point) else _whole(front)
    tried = []
    for height in _HEIGHTS:
        for bearing in _BEARINGS:
            camera = _camera(front, points, float(bearing), height)
            share = visible.seen(candidates.path(front, camera))
            likes = candidates.liking(front, float(bearing)) + candidates.framed(share)
            tried.append(Tried(share, likes - _STEEP * (height - _HEIGHTS[0]), camera))
    share, _, camera = candidates.best(tried)
    return PlacedCamera(camera, share.share, _words(front, camera, share))


def _camera(front: MovingFront, points: Array, bearing: float, height: float) -> Camera:
    """Camera in a direction and elevation (degrees) from the points, as near as they all allow."""
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
    front: MovingFront, points: Array, direction: Array, least: float, most: float
) -> tuple[float, Array, float]:
    """Longest lens: focal length (mm), tangents of half angles of view, and distance (m).

    Parameters
    ----------
    points
        Points (n, 3) that must be in the picture, m from their centre.
    direction
        Unit vector (3,) from the centre to the camera.
    least, most
        Allowed distances, m. If even the widest lens needs more, the distance is `most`.
    """
    aspect = np.divide(*front.shot.settings.render.resolution[::-1])
    for lens in _LENSES:
        half = 0.5 * candidates.SENSOR / lens * np.array([1.0, aspect])
        away = _nearest(points, direction, half, least)
        if away <= most:
            break
    return lens, half, min(away, most)


def _under(half: Array) -> float:
    """Angle (radians) of the front's centre below the picture's centre."""
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
    """Return whether the front's part of the picture contains all but a few points."""
    right, above, back = ((points - eye) @ rotation).T
    ahead = np.maximum(-back, 1.0e-6)
    x, y = right / ahead / half[0], above / ahead / half[1]
    sides, lowest, highest = _ROOM
    outside = (back >= 0.0) | (np.abs(x) > sides) | (y < lowest) | (y > highest)
    return float(np.mean(outside)) <= _STRAY


def _middle(points: Array, side: Array) -> Array:
    """Centre (3,) of the points' bounds along and across a direction, at their mean height."""
    across = np.array([-side[1], side[0], 0.0])
    ends = [np.percentile(points @ axis, [1.0, 99.0]).mean() * axis for axis in (side, across)]
    return ends[0] + ends[1] + np.array([0.0, 0.0, float(points[:, 2].mean())])


def _room(front: MovingFront, middle: Array, side: Array) -> float:
    """Largest distance (m) of a camera from the centre on a side, by the terrain's extent."""
    reach = candidates.INSIDE * front.shot.settings.terrain.apron
    here = middle[:2]  # relative to the run's centre, the scene's origin
    along = float(here @ side[:2])
    beside = max(along**2 - float(here @ here) + reach**2, 0.0)
    return max(-along + float(np.sqrt(beside)), _LEAST * reach)


def _whole(front: MovingFront) -> Array:
    """Corners (4, 3) of the run's terrain, for a run without fire."""
    x, y = np.meshgrid(*np.stack([front.low, front.high], axis=-1))
    return np.stack([x.ravel(), y.ravel(), front.ground.up(x.ravel(), y.ravel())], axis=-1)


def _words(front: MovingFront, camera: Camera, visible: VisibleShare) -> str:
    """Describe the camera in one line."""
    (key,) = camera.rig.keys
    view = candidates.path(front, camera)
    side = candidates.where(front, candidates.bearing(view))
    text = f"{side}: {candidates.distance(candidates.away(view))} away, {key.height:,.0f} m up"
    if not len(front.point):
        return f"{text}; nothing burns in the run"
    return f"{text}; {candidates.shows(visible, 'the front')}"
