"""Rotations as matrices and as unit quaternions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
    """Compute rotation matrices (n, 3, 3) of quaternions (n, 4) of any length."""
    w, x, y, z = (quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)).T
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
