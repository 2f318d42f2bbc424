"""Dilation of masks, and maximum filters of fields, over square neighbourhoods."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray


def dilate(field: NDArray, reach: int, beyond: float | bool | None = None) -> NDArray:
    """Return the maximum over `reach` rows and columns on each side of each element of a field (ny, nx).

    Parameters
    ----------
    beyond
        Value outside of the field; if None, the values at the edge are repeated.
    """
    for axis in (0, 1):
        width = [(reach, reach) if k == axis else (0, 0) for k in (0, 1)]
        if beyond is None:
            padded = np.pad(field, width, "edge")
        else:
            padded = np.pad(field, width, constant_values=beyond)
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis)
        field = functools.reduce(np.maximum, np.moveaxis(windows, -1, 0))
    return field
