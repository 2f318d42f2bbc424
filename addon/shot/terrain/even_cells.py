"""Averages of apron fields over squares: cells of the apron are long, and single cells would be streaks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...run import areas
from .apron import TerrainFields

Array = NDArray[np.float64]

_CELLS = 3.0  # long sides over which values are averaged: a neighbourhood of 3 x 3 cells


def average(values: Array, fields: TerrainFields) -> Array:
    """Average values (ny, nx) of the apron along the short sides of its cells, over three of the long ones.

    The values of the run's own grid are unchanged.
    """
    margin = fields.margin
    if margin == 0:
        return values
    sizes = areas.metres_per_degree(float(np.mean(fields.latitude)))
    y, x = (axis * size for axis, size in zip((fields.latitude, fields.longitude), sizes, strict=True))
    across = _average_rows(values, x, _CELLS * np.gradient(y), margin)
    return _average_rows(across.T, y, _CELLS * np.gradient(x), margin).T


def _average_rows(values: Array, place: Array, width: Array, margin: int) -> Array:
    """Average the outer `margin` rows (n, m) along columns at places (m,), over widths (n,), all in m."""
    averages = values.copy()
    for row in (*range(margin), *range(len(values) - margin, len(values))):
        total = np.concatenate([[0.0], np.cumsum(values[row])])
        low = np.searchsorted(place, place - 0.5 * width[row])
        high = np.searchsorted(place, place + 0.5 * width[row], "right")
        averages[row] = (total[high] - total[low]) / (high - low)
    return averages
