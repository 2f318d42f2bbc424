"""Estimate of the point spacing of a cloud from the number of points per cell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_IN_A_CELL = 8.0
"""Approximate points per cell."""
_ITERATIONS = 6


def estimate(position: NDArray[np.float32]) -> float:
    """Estimate the distance of neighbouring points (n, 3) of a surface, m: sqrt(area / n); 0 if n < 2.

    The area is the total area of occupied cells; the cell size gives about 8 points per cell.
    """
    points = np.asarray(position, np.float64)
    if len(points) < 2:
        return 0.0
    points = points - points.min(axis=0)
    size = float(points.max())
    if size <= 0.0:
        return 0.0
    wanted = min(_IN_A_CELL, max(len(points) / 4.0, 1.0))
    side = size / np.sqrt(len(points) / wanted)
    for _ in range(_ITERATIONS):
        shared = len(points) / _count_cells(points, side)
        side = min(side * float(np.clip(np.sqrt(wanted / shared), 0.25, 4.0)), size)
    return float(side * np.sqrt(_count_cells(points, side) / len(points)))


def _count_cells(points: NDArray[np.float64], side: float) -> int:
    """Count occupied cells."""
    x, y, z = np.floor(points / side).astype(np.int64).T
    return len(np.unique((x << 42) ^ (y << 21) ^ z))
