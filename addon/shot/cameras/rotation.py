"""Camera rotations: matrices, and heading, tilt and roll, in double precision."""

from __future__ import annotations

import numpy as np
from firetwin_core import geo

from .path import Array, compass

_UPRIGHT = 1.0e-9  # sine of the angle from the vertical below which heading is undefined


def turned(frame: geo.LocalFrame, place: Array, heading: float, tilt: float, roll: float) -> Array:
    """Rotation matrix (3, 3), columns right, up and back, from heading, tilt and roll at a scene point (3,).

    Parameters
    ----------
    heading, tilt, roll
        Bearing clockwise from north, angle below the horizon and lean to the right, degrees, in the local
        east-north-up frame of the point.
    """
    right, above, back = _level(frame, place, np.radians(heading), np.radians(tilt))
    c, s = np.cos(np.radians(roll)), np.sin(np.radians(roll))
    return np.stack([c * right - s * above, s * right + c * above, back], axis=-1)


def angles(frame: geo.LocalFrame, place: Array, rotation: Array) -> tuple[float, float, float]:
    """Heading, tilt and roll, degrees, of a camera matrix (3, 3): inverse of `turned`.

    A camera that looks straight up or down takes its heading from its picture's edge and has no roll.
    """
    east, north, up = compass(frame, place)
    ahead = -rotation[:, 2]
    tilt = float(np.arctan2(-ahead @ up, np.hypot(ahead @ east, ahead @ north)))
    edge = ahead if np.cos(tilt) > _UPRIGHT else rotation[:, 1] * np.sign(tilt)
    heading = float(np.arctan2(edge @ east, edge @ north))
    right, above, _ = _level(frame, place, heading, tilt)
    roll = np.arctan2(-rotation[:, 0] @ above, rotation[:, 0] @ right)
    return float(np.degrees(heading)) % 360.0, float(np.degrees(tilt)), float(np.degrees(roll))


def _level(frame: geo.LocalFrame, place: Array, heading: float, tilt: float) -> tuple[Array, Array, Array]:
    """Right, up and back (3,) of a camera with a level horizon; angles in radians."""
    east, north, up = compass(frame, place)
    flat = np.sin(heading) * east + np.cos(heading) * north
    right = np.cos(heading) * east - np.sin(heading) * north
    back = -np.cos(tilt) * flat + np.sin(tilt) * up
    return right, np.cross(back, right), back
