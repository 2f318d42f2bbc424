"""Distance of smoke: where it reaches half of its opacity along each line of sight."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]
March = Callable[[NDArray[np.float64], NDArray[np.float64], Array], Array]
"""Marches rays from origins (3,) or (n, 3) along directions (n, 3) to distances (n, taps), m; returns the
transmittance of smoke up to each of them."""

STEP = 1.0  # voxels, step along rays; half of it, as in films, takes twice the time
_SPARSE = 2  # pixels along a block with one ray
_SEEN = 0.01  # opacity of smoke from which it has a distance
_NEAREST, _FARTHEST, _TAPS = 5.0, 6.0e4, 40  # m; distances along a ray at which opacity is known


def measure(
    origins: NDArray[np.float64],
    directions: NDArray[np.float64],
    distance: Array,
    clear: Array,
    march: March,
) -> Array:
    """Measure the distance (h, w) at which smoke reaches half of its opacity, m; inf without smoke.

    Parameters
    ----------
    origins, directions
        Rays through pixel centres: (3,) or (h, w, 3) m, and (h, w, 3) unit vectors.
    distance, clear
        (h, w) distance of the surface, m, and transmittance of the smoke before it.
    """
    row, column = _densest(clear)
    seen = clear[row, column] < 1.0 - _SEEN
    coarse = np.full(seen.shape, np.inf, np.float32)
    if seen.any():
        chosen = row[seen], column[seen]
        ends = np.minimum(distance[chosen], _FARTHEST)
        at = np.geomspace(np.minimum(_NEAREST, ends), ends, _TAPS, axis=-1).astype(np.float32)
        start = origins if origins.ndim == 1 else origins[chosen]
        coarse[seen] = _half_opacity(at, march(start, directions[chosen], at))
    down, across = (
        np.minimum(np.arange(n) // _SPARSE, m - 1) for n, m in zip(clear.shape, seen.shape, strict=True)
    )
    return np.where(clear < 1.0 - _SEEN, coarse[np.ix_(down, across)], np.inf).astype(np.float32)


def _half_opacity(at: Array, through: Array) -> Array:
    """Interpolate the distance (n,) of half of the opacity between distances (n, taps) of transmittances."""
    half = 0.5 * (1.0 + through[:, -1:])
    after = np.argmax(through <= half, axis=1)
    rows, before = np.arange(len(at)), np.maximum(after - 1, 0)
    high, low = through[rows, before], through[rows, after]
    part = np.clip((high - half[:, 0]) / np.maximum(high - low, 1.0e-6), 0.0, 1.0)
    away = at[rows, before] + part * (at[rows, after] - at[rows, before])
    return np.where(through[:, -1] < 1.0 - 0.5 * _SEEN, away, np.inf)


def _densest(clear: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return row and column of the pixel with the densest smoke in each block of `_SPARSE` pixels."""
    height, width = (side // _SPARSE * _SPARSE for side in clear.shape)
    blocks = clear[:height, :width].reshape(height // _SPARSE, _SPARSE, width // _SPARSE, _SPARSE)
    blocks = blocks.swapaxes(1, 2).reshape(height // _SPARSE, width // _SPARSE, _SPARSE**2)
    down, across = np.divmod(blocks.argmin(axis=-1), _SPARSE)
    corner = np.meshgrid(*(np.arange(0, side, _SPARSE) for side in (height, width)), indexing="ij")
    return corner[0] + down, corner[1] + across
