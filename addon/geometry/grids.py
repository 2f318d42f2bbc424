"""Dilation and neighbourhoods of masks, maximum and smoothing filters of fields, and connected components."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]


def dilate(field: NDArray, reach: int, beyond: float | bool | None = None) -> NDArray:
    """Return the maximum over `reach` elements on each side of each element of a field, along all axes.

    Parameters
    ----------
    beyond
        Value outside of the field; if None, the values at the edge are repeated.
    """
    for axis in range(field.ndim):
        width = [(reach, reach) if k == axis else (0, 0) for k in range(field.ndim)]
        if beyond is None:
            padded = np.pad(field, width, "edge")
        else:
            padded = np.pad(field, width, constant_values=beyond)
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis)
        field = functools.reduce(np.maximum, np.moveaxis(windows, -1, 0))
    return field


def within(mask: Mask, reach: float, cell: tuple[float, float]) -> Mask:
    """Mask the cells (h, w) whose centre is within a distance of the centre of a cell of a mask.

    Parameters
    ----------
    reach
        Largest Euclidean distance, m.
    cell
        Width and height of a cell, m.
    """
    width, height = cell
    rows, columns = mask.shape
    count = np.pad(np.cumsum(mask, axis=1), ((0, 0), (1, 0)))
    column, near = np.arange(columns), np.zeros(mask.shape, np.bool_)
    for down in range(min(int(reach / height), rows - 1) + 1):
        across = int(np.sqrt(reach**2 - (down * height) ** 2) / width)
        last, first = np.minimum(column + across + 1, columns), np.maximum(column - across, 0)
        row = count[:, last] > count[:, first]
        near[down:] |= row[: rows - down]
        near[: rows - down] |= row[down:]
    return near


def blur(values: NDArray) -> NDArray:
    """Compute the centre-weighted mean (h, w, c) of each 3 x 3 neighbourhood."""
    padded = np.pad(values, ((1, 1), (1, 1), (0, 0)), mode="edge")
    rows = 0.25 * padded[:-2] + 0.5 * padded[1:-1] + 0.25 * padded[2:]
    return 0.25 * rows[:, :-2] + 0.5 * rows[:, 1:-1] + 0.25 * rows[:, 2:]


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
