"""Areas of rings, and points inside polygons by the even-odd rule."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_AT_ONCE = 1 << 16  # pairs of points and sides per array: these fit a processor's cache


def area(ring: Array) -> float:
    """Compute the area of a ring (n, 2), closed or not, positive if anticlockwise (shoelace formula)."""
    x, y = (ring - ring[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def inside(rings: Sequence[Array], points: Array) -> NDArray[np.bool_]:
    """Check which points (n, 2) are within the outer ring and outside all holes (even-odd rule).

    Parameters
    ----------
    rings
        (k, 2) each, closed or not.
    """
    first = np.concatenate(rings)
    second = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    is_inside = np.all((points >= first.min(axis=0)) & (points <= first.max(axis=0)), axis=1)
    near = np.flatnonzero(is_inside)
    rise = np.where(first[:, 1] == second[:, 1], 1.0, second[:, 1] - first[:, 1])
    step = max(_AT_ONCE // len(first), 1)
    for start in range(0, len(near), step):
        some = near[start : start + step]
        x, y = points[some, None].transpose(2, 0, 1)
        crosses = (first[:, 1] > y) != (second[:, 1] > y)
        at = first[:, 0] + (y - first[:, 1]) / rise * (second[:, 0] - first[:, 0])
        is_inside[some] = np.sum(crosses & (x < at), axis=1) % 2 == 1
    return is_inside
