"""Connected components of masks, numbered in the order of their first pixels, row by row."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]


def label(mask: Mask) -> tuple[Labels, int]:
    """Label the components of a mask (h, w); pixels that touch at an edge or a corner are connected.

    Returns
    -------
    labels
        (h, w) number of the component, from 1; 0 outside.
    count
        Number of components.
    """
    labels = np.zeros(mask.shape, np.int32)
    change = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, start = np.nonzero(change == 1)
    stop = np.nonzero(change == -1)[1]
    if not len(row):
        return labels, 0
    parent = _join(*_contacts(row, start, stop, mask.shape[1] + 2), len(row))
    roots, number = np.unique(parent, return_inverse=True)
    labels[mask] = np.repeat(number + 1, stop - start)
    return labels, len(roots)


def group(mask: Mask, gap: int) -> tuple[Labels, int]:
    """Label groups of components whose gaps are at most `gap` pixels, as `label` does.

    A plume that a trunk or a narrow ridge divides is so one group. Gaps are counted along the axis with more
    pixels; an odd `gap` is rounded down to an even number.
    """
    labels, count = label(dilate(mask, gap // 2))
    return np.where(mask, labels, 0).astype(np.int32), count


def dilate(mask: Mask, reach: int) -> Mask:
    """Widen a mask (h, w) by a square of 2 `reach` + 1 pixels."""
    for axis in (0, 1):
        if reach > 0:
            mask = _moving_sum(mask.astype(np.int64), reach, axis) > 0
    return mask


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


def _contacts(row: NDArray, start: NDArray, stop: NDArray, width: int) -> tuple[NDArray, NDArray]:
    """Find pairs of runs of pixels in consecutive rows that touch; runs are sorted by row and start."""
    above = (row - 1) * width
    first = np.searchsorted(row * width + stop, above + start, "left")
    last = np.searchsorted(row * width + start, above + stop, "right")
    count = np.maximum(last - first, 0)
    lower = np.repeat(np.arange(len(row)), count)
    step = np.arange(len(lower)) - np.repeat(np.cumsum(count) - count, count)
    return np.repeat(first, count) + step, lower


def _join(one: NDArray, other: NDArray, count: int) -> NDArray[np.int64]:
    """Find the smallest member of the set that each of `count` members belongs to, given its connections."""
    parent = np.arange(count)
    while True:
        a, b = parent[one], parent[other]
        if np.array_equal(a, b):
            return parent
        np.minimum.at(parent, np.maximum(a, b), np.minimum(a, b))
        while not np.array_equal(parent, parent[parent]):
            parent = parent[parent]
