"""Ground around 3D Tiles, raised or lowered to meet their border without a step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def meet(tiles: NDArray, ground: NDArray, width: int) -> NDArray[np.float32]:
    """Join heights (ny, nx) of tiles and of the ground around them, which meets them within `width` points.

    At the border the ground is moved by its difference from the tiles; farther out this fades to 0.

    Parameters
    ----------
    tiles
        (ny, nx) m; NaN without tiles.
    ground
        (ny, nx) m; NaN at unknown points.
    """
    known = np.isfinite(tiles)
    off, ring = _continued(np.where(known, tiles - ground, np.nan), width)
    part = 1.0 - ring / np.float32(width + 1)
    beside = ground + np.nan_to_num(off) * part * part * (3.0 - 2.0 * part)
    return np.where(known, tiles, beside).astype(np.float32)


def continued(values: NDArray, width: int) -> NDArray[np.float32]:
    """Continue values (ny, nx) into unknown points for `width` points; NaN farther away."""
    return _continued(values, width)[0]


def _continued(values: NDArray, width: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return continued values, each the mean of its known neighbours, and the distances from known points."""
    is_known = np.isfinite(values)
    values, ring = np.where(is_known, values, 0.0).astype(np.float32), np.zeros(values.shape, np.float32)
    for number in range(1, width + 1):
        count = _neighbours(is_known.astype(np.float32))
        new = ~is_known & (count > 0.0)
        if not new.any():
            break
        values[new] = _neighbours(values)[new] / count[new]
        ring[new] = number
        is_known |= new
    return np.where(is_known, values, np.float32(np.nan)), ring


def _neighbours(field: NDArray[np.float32]) -> NDArray[np.float32]:
    """Sum over the eight neighbours."""
    padded = np.pad(field, 1)
    three = padded[:-2] + padded[1:-1] + padded[2:]
    return three[:, :-2] + three[:, 1:-1] + three[:, 2:] - field
