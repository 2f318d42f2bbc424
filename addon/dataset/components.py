"""Groups of pixels, and means over squares."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..geometry.grids import Labels, Mask, dilate, label


def group(mask: Mask, gap: int) -> tuple[Labels, int]:
    """Label groups of components whose gaps are at most `gap` pixels, as `label` does.

    A plume that a trunk or a narrow ridge divides is so one group. Gaps are counted along the axis with more
    pixels; an odd `gap` is rounded down to an even number.
    """
    labels, count = label(dilate(mask, gap // 2, beyond=False))
    return np.where(mask, labels, 0).astype(np.int32), count


def fill(mask: Mask, gap: int) -> Mask:
    """Fill gaps of at most `gap` pixels within a mask, and its holes; an odd `gap` is rounded down."""
    reach = gap // 2
    closed = mask | ~dilate(~dilate(mask, reach, beyond=False), reach, beyond=False)
    outside, count = label(~closed)
    is_hole = np.arange(count + 1) > 0
    for edge in (outside[0], outside[-1], outside[:, 0], outside[:, -1]):
        is_hole[edge] = False
    return closed | is_hole[outside]


def local_mean(values: NDArray, reach: int) -> NDArray[np.float64]:
    """Average values (h, w, ...) over squares of 2 `reach` + 1 pixels, within the picture."""
    total, weight = values.astype(np.float64), np.ones(values.shape[:2])
    for axis in (0, 1):
        total, weight = _moving_sum(total, reach, axis), _moving_sum(weight, reach, axis)
    return total / weight.reshape(weight.shape + (1,) * (total.ndim - 2))


def _moving_sum(values: NDArray, reach: int, axis: int) -> NDArray:
    """Sum over 2 `reach` + 1 neighbours along an axis; beyond the edges are zeros."""
    pads = [(reach + 1, reach) if k == axis else (0, 0) for k in range(values.ndim)]
    total = np.cumsum(np.pad(values, pads), axis=axis)
    size = values.shape[axis]
    ends, starts = (range(first, first + size) for first in (2 * reach + 1, 0))
    return np.take(total, ends, axis) - np.take(total, starts, axis)
