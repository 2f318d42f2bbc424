"""Visible cells of a grid by hierarchical culling: blocks first, then cells, as most are out of view."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ...run import areas
from ...shot.shot import Shot
from . import visibility

_RELIEF = 30.0  # m; greatest vertical offset of a tree by the terrain mesh's relief
_BLOCK = 8  # cells along a block's side

Array = NDArray[np.float64]


def visible_cells(
    shot: Shot,
    height: float,
    reach: float,
    latitude: Array,
    longitude: Array,
    elevation: NDArray,
    among: NDArray[np.bool_] | None = None,
) -> NDArray[np.bool_]:
    """Cells (fy, fx) of a grid where a plant up to this height (m) may be visible (`visibility.visible`).

    Parameters
    ----------
    reach
        Greatest distance of such plants from perspective cameras, m.
    latitude, longitude, elevation
        (fy,), (fx,) degrees and (fy, fx) m of the cells' centres; NaN without terrain.
    among
        (fy, fx) cells to test.
    """
    counts = _blocks(shot, height, reach, latitude, longitude, elevation)
    if among is not None:
        counts &= among
    row, column = np.nonzero(counts)
    foot = shot.local_frame.forward(latitude[row], longitude[column], elevation[row, column])
    size = _size(shot, latitude, longitude, _slope(elevation, row, column))
    counts[row, column] = visibility.visible(shot, foot, height, reach, offset=size)
    return counts


def _size(shot: Shot, latitude: Array, longitude: Array, slope: Array) -> Array:
    """Radius (n,) m of a cell's plants round its centre, from its elevation steps to neighbours."""
    scale = areas.metres_per_degree(shot.local_frame.latitude)
    north, east = (
        metres * np.abs(np.diff(axis)).max() if len(axis) > 1 else own
        for own, metres, axis in zip(shot.ground.cell, scale, (latitude, longitude), strict=True)
    )
    return np.hypot(0.5 * np.hypot(north, east), slope) + max(_RELIEF, shot.ground.rough)


def _slope(elevation: NDArray, row: NDArray[np.int64], column: NDArray[np.int64]) -> Array:
    """Sum of the largest finite elevation steps of cells (n,) to their neighbours along each axis."""
    here, total = elevation[row, column].astype(np.float64), np.zeros(len(row))
    rows, columns = elevation.shape
    for ahead, aside in ((1, 0), (0, 1)):
        beside = (
            elevation[np.clip(row + s * ahead, 0, rows - 1), np.clip(column + s * aside, 0, columns - 1)]
            for s in (-1, 1)
        )
        total += np.maximum(*(np.nan_to_num(np.abs(there - here)) for there in beside))
    return total


def _blocks(
    shot: Shot, height: float, reach: float, latitude: Array, longitude: Array, elevation: NDArray
) -> NDArray[np.bool_]:
    """Cells (fy, fx) in blocks that may be visible; conservative: no visible cell is missing."""
    rows, columns = (np.arange(0, count, _BLOCK) for count in elevation.shape)
    low, high = (
        f.reduceat(f.reduceat(elevation, rows, axis=0), columns, axis=1).astype(np.float64)
        for f in (np.fmin, np.fmax)
    )
    north, east = (
        0.5 * (axis[at] + _last(axis, at)) for axis, at in ((latitude, rows), (longitude, columns))
    )
    middle = shot.local_frame.forward_grid(north, east, 0.5 * (low + high))
    corners = (
        shot.local_frame.forward_grid(y, x, 0.5 * (low + high))
        for y in (latitude[rows], _last(latitude, rows))
        for x in (longitude[columns], _last(longitude, columns))
    )
    across = np.max([np.linalg.norm(corner - middle, axis=-1) for corner in corners], axis=0)
    known = np.isfinite(across)
    steps = dilate(np.where(known, high, -np.inf), 1) + dilate(np.where(known, -low, -np.inf), 1)
    size = across + 0.5 * (high - low) + _size(shot, latitude, longitude, 2.0 * steps)
    counts = np.zeros(known.shape, bool)
    counts[known] = visibility.visible(shot, middle[known], height, reach, offset=size[known])
    whole = np.repeat(np.repeat(counts, _BLOCK, axis=0), _BLOCK, axis=1)
    return whole[: elevation.shape[0], : elevation.shape[1]].copy()


def _last(axis: Array, first: NDArray[np.int64]) -> Array:
    """Values of an axis at the last cells of blocks with these first cells."""
    return axis[np.minimum(first + _BLOCK, len(axis)) - 1]
