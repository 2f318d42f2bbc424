"""Fire front of a run at any time: burned state of points, and the front as a contour line.

Both match the scores (see `arrival_grid.fill_unburned`): the front moves at constant speed between two cell
centres, and a front that has stopped lies half-way between them.
"""

from __future__ import annotations

import functools
from functools import cached_property

import numpy as np
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from . import areas
from .arrival_grid import ArrivalGrid, fill_unburned, pad_axis

_FINE = 80.0  # m; a coarser grid is subdivided so that lines follow the terrain
_CACHED = 4  # runs, for comparisons

Array = NDArray[np.float64]


class Reach:
    """Burned area of a run as a function of time.

    Attributes
    ----------
    latitude, longitude
        Cell centres with one more at each end, degrees.
    arrival
        Arrival times at these (ny, nx), s; NaN where never, as in the margin.
    """

    def __init__(self, grid: ArrivalGrid) -> None:
        self.latitude, self.longitude = pad_axis(grid.latitude), pad_axis(grid.longitude)
        self.arrival = np.pad(grid.arrival, 1, constant_values=np.nan)
        self.divided = max(1, int(np.ceil(max(grid.cell) / _FINE)))

    @cached_property
    def _middle(self) -> float:
        return 0.5 * float(self.longitude[0] + self.longitude[-1])

    def at(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Convert points (degrees) to fractional rows and columns of `arrival`; NaN beyond the margin."""
        longitude = areas.turned(longitude, self._middle)
        row, column = (
            np.interp(np.asarray(at, np.float64), axis, np.arange(len(axis)), left=np.nan, right=np.nan)
            for at, axis in ((latitude, self.latitude), (longitude, self.longitude))
        )
        inside = np.isfinite(row) & np.isfinite(column)
        return np.where(inside, row, np.nan), np.where(inside, column, np.nan)

    def burned(self, latitude: ArrayLike, longitude: ArrayLike, time: float) -> Array:
        """Find the state of points (degrees) at a model time (s): 1 burned, 0 not, NaN outside the grid."""
        row, column = self.at(latitude, longitude)
        since = bilinear(fill_unburned(self.arrival - time), np.nan_to_num(row), np.nan_to_num(column))
        return np.where(np.isfinite(row), since <= 0.0, np.nan)

    def line(self, time: float) -> tuple[Array, Array, NDArray[np.int64]]:
        """Trace the front at a model time (s): latitude, longitude (n,) and the index of the next point."""
        burned = self.arrival <= time
        if not burned.any():
            return np.empty(0), np.empty(0), np.empty(0, np.int64)
        box = tuple(
            slice(max(int(found[0]) - 2, 0), int(found[-1]) + 3)
            for found in (np.flatnonzero(burned.any(axis)) for axis in (1, 0))
        )
        since = fill_unburned(self.arrival[box] - time)
        row, column, after = contour(divide(since, self.divided))
        latitude, longitude = (
            np.interp(at / self.divided, np.arange(axis[part].size), axis[part])
            for at, axis, part in ((row, self.latitude, box[0]), (column, self.longitude, box[1]))
        )
        return latitude, longitude, after


@functools.lru_cache(maxsize=_CACHED)
def reach(run: Run) -> Reach:
    """Return the burned area of a run; results of the latest runs are cached."""
    return Reach(ArrivalGrid.from_run(run))


def divide(field: Array, parts: int) -> Array:
    """Interpolate a field (ny, nx) bilinearly at `parts` points per cell along each axis."""
    if parts == 1:
        return field
    row, column = (np.linspace(0, count - 1, (count - 1) * parts + 1) for count in field.shape)
    return bilinear(field, *np.meshgrid(row, column, indexing="ij"))


def contour(field: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Trace the zero contour of a field (ny, nx): fractional rows, columns (n,), and index of the next point.

    Marching squares with linear interpolation between neighbours. Lines are closed. Values of 0 or less lie
    on their left, with columns to the right and rows up. The contour must not reach the field's border.
    """
    inside = field <= 0.0
    corners = [inside[:-1, :-1], inside[:-1, 1:], inside[1:, 1:], inside[1:, :-1]]
    number = np.arange(field.size).reshape(field.shape)
    sides = [number[:-1, :-1], number[:-1, 1:] + field.size, number[1:, :-1], number[:-1, :-1] + field.size]
    leaves = [corners[k] & ~corners[(k + 1) % 4] for k in range(4)]
    enters = [~corners[k] & corners[(k + 1) % 4] for k in range(4)]
    crossed = np.sum(leaves, axis=0, dtype=np.int8) == 2
    joined = 0.25 * (field[:-1, :-1] + field[:-1, 1:] + field[1:, 1:] + field[1:, :-1]) <= 0.0
    from_sides, to_sides = [], []
    for k in range(4):
        for step in (1, 2, 3):
            other = (k + step) % 4
            mask = leaves[k] & enters[other]
            if step == 2:
                mask &= ~crossed
            else:
                mask &= ~crossed | (joined if step == 1 else ~joined)
            from_sides.append(sides[k][mask])
            to_sides.append(sides[other][mask])
    here, there = np.concatenate(from_sides), np.concatenate(to_sides)
    points = np.unique(here)
    after = np.empty(len(points), np.int64)
    after[np.searchsorted(points, here)] = np.searchsorted(points, there)
    upright = points >= field.size
    row, column = np.divmod(points % field.size, field.shape[1])
    low, high = field[row, column], field[row + upright, column + ~upright]
    part = low / (low - high)
    return row + part * upright, column + part * ~upright, after
