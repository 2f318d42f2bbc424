"""Camera rotations: matrices, quaternions, and heading, tilt and roll, in double precision."""

from __future__ import annotations

import numpy as np
from firetwin_core import geo

from .path import Array, compass

_UPRIGHT = 1.0e-9  # sine of the angle from the vertical below which heading is undefined


def quaternions(rotation: Array) -> Array:
    """Compute unit quaternions (n, 4) (w, x, y, z) of matrices (n, 3, 3), with continuous sign.

    The largest component is computed first for precision (Shepperd 1978).
    """
    r = np.asarray(rotation, np.float64)
    trace = np.einsum("nii->n", r)
    whole = np.empty((len(r), 4, 4))  # four times the products of the components
    whole[:, 0, 0] = 1.0 + trace
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        whole[:, i + 1, i + 1] = 1.0 + 2.0 * r[:, i, i] - trace
        whole[:, 0, i + 1] = whole[:, i + 1, 0] = r[:, k, j] - r[:, j, k]
        whole[:, i + 1, j + 1] = whole[:, j + 1, i + 1] = r[:, i, j] + r[:, j, i]
    largest = np.argmax(np.einsum("nii->ni", whole), axis=1)
    quaternion = whole[np.arange(len(r)), largest]
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    flipped = np.sum(quaternion[1:] * quaternion[:-1], axis=1) < 0.0
    quaternion[1:] *= np.where(np.cumsum(flipped) % 2, -1.0, 1.0)[:, None]
    return quaternion


def matrices(quaternion: Array) -> Array:
    """Rotation matrices (n, 3, 3) of quaternions (n, 4) of any length."""
    w, x, y, z = (quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)).T
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


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
