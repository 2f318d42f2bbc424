"""Placement of a sample's camera, and the checks that reject a placement."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..shot.cameras import rotation
from .run_scene import RunScene
from .sites import Tower

_NEAREST = 20.0  # m, least distance of a camera from the front (assumed)
_PLUME = 300.0  # m, height above the front at which smoke is expected (assumed)
# Parts of the distance to the target, and largest mean opacity of smoke in the picture up to there (by eye)
_VEILS = (0.25, 0.3), (1.0, 0.8)
_CROWD = 40.0, 0.5  # m, and largest share of the picture that crowns closer than this fill (by eye)
_LINE = 0.33, 400.0  # parts of the line to the target, and m, in which no crown is in the way (by eye)
_EDGE = 0.98  # place of a fire that the edge of the picture cuts

Array = NDArray[np.float64]
ValueOf = Callable[[str], float]


class Rejected(Exception):  # noqa: N818 (the sample is drawn again)
    """The drawn camera does not suit its sample; the text is the reason."""


class Lens(NamedTuple):
    """Tangents of half the horizontal and vertical angle of view, and place of the target, -1..1."""

    half: tuple[float, float]
    x: float
    y: float


class Pose(NamedTuple):
    """Camera: position (3,), m, and rotation (3, 3) in the run's local frame."""

    position: Array
    rotation: Array


def lens(value: ValueOf, resolution: tuple[int, int]) -> Lens:
    """Draw the lens, and the place of the target in the picture."""
    across = float(np.tan(np.radians(value("field_of_view")) / 2.0))
    x = value("frame_x")
    if value("edge") >= 0.5:
        x = float(np.copysign(_EDGE, x))
    return Lens((across, across * resolution[1] / resolution[0]), x, value("frame_y"))


def place_mobile(scene: RunScene, kind: str, time: float, target: Array, lens: Lens, value: ValueOf) -> Pose:
    """Place a drone, an aircraft or a camera that looks down so that the target has its place in the picture.

    Parameters
    ----------
    kind
        "drone", "aircraft" or "nadir".
    time
        Model time, s.
    target
        (3,) m.
    """
    heading = scene.upwind(time) + 180.0 + value("bearing_from_wind")
    tilt = 90.0 if kind == "nadir" else -value(f"pitch_{kind}")
    roll = 0.0 if kind == "nadir" else value("roll")
    turned = rotation.turned(scene.ground.frame, target, heading, tilt, roll)
    ray = np.array([lens.x * lens.half[0], lens.y * lens.half[1], -1.0])
    ray /= np.linalg.norm(ray)
    return Pose(target - value(f"distance_{kind}") * turned @ ray, turned)


def aim_tower(scene: RunScene, tower: Tower, target: Array, lens: Lens, value: ValueOf) -> Pose:
    """Turn the camera of a tower so that the target has its place from left to right; the pitch is drawn."""
    level = rotation.turned(scene.ground.frame, tower.position, 0.0, 0.0, 0.0)
    away = (target - tower.position) @ level
    bearing = np.arctan2(away[0], -away[2]) - np.arctan(lens.x * lens.half[0])
    angles = float(np.degrees(bearing)), -value("pitch_tower"), value("roll")
    return Pose(tower.position, rotation.turned(scene.ground.frame, tower.position, *angles))


def check(scene: RunScene, pose: Pose, is_mobile: bool) -> None:
    """Check that a camera is above the terrain.

    Raises
    ------
    Rejected
        It is not.
    """
    if not scene.has_ground(pose.position):
        raise Rejected("outside the terrain")
    least = scene.clearance(pose.position) if is_mobile else 1.0
    if scene.height_above_ground(pose.position) < least:
        raise Rejected("too close to the ground")


def check_trees(scene: RunScene, pose: Pose, half: tuple[float, float], target: Array) -> None:
    """Check that crowns near a camera neither fill its picture nor hide its target (3,), m.

    Raises
    ------
    Rejected
        They do.
    """
    if not scene.settings.forest.trees:
        return
    away = target - pose.position
    share = min(_LINE[0], _LINE[1] / float(np.linalg.norm(away)))
    line = pose.position + share * np.linspace(0.1, 1.0, 24)[:, None] * away
    if scene.in_crowns(line).any() or scene.crowded(*pose, half, _CROWD[0]) > _CROWD[1]:
        raise Rejected("behind trees")


def check_sight(distance: float, visibility: float) -> None:
    """Check that a target is not farther away, m, than the meteorological visibility, km.

    Raises
    ------
    Rejected
        It is.
    """
    if distance > 1000.0 * visibility:
        raise Rejected("beyond the visibility")


def check_fire(
    scene: RunScene, pose: Pose, time: float, lens: Lens, distance: float, allow_hidden: bool
) -> None:
    """Check that a camera shows the front, or at least smoke if terrain may hide all flames.

    Parameters
    ----------
    distance
        From the camera to its target, m.
    allow_hidden
        Terrain may hide all flames.

    Raises
    ------
    Rejected
        It does not, or it is in the flames.
    """
    front = scene.front(time)
    if len(front) == 0:
        raise Rejected("no fire at this time")
    if float(np.linalg.norm(front - pose.position, axis=1).min()) < _NEAREST:
        raise Rejected("too close to the front")
    points = np.concatenate([front, front + np.array([0.0, 0.0, _PLUME])]) if allow_hidden else front
    if not scene.visible(points, *pose, lens.half).any():
        raise Rejected("no fire in view")
    for part, most in _VEILS:
        if scene.veil(time, *pose, lens.half, part * distance) > most:
            raise Rejected("in the smoke")
