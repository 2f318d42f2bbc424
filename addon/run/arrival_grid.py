"""Arrival grid: the arrival time of a run's fire on the fuel grid, and the state of each cell at a time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from . import areas, burned_fraction

NEVER = 1e12  # s


@dataclass(frozen=True)
class ArrivalGrid:
    """Cell centres (degrees, from south and west) and arrival times (ny, nx), s; NaN: never burns.

    `fraction` returns the burned fraction (ny, nx) at a model time (s), for runs that have this field.
    """

    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    arrival: NDArray[np.float64]
    fraction: Callable[[float], NDArray] | None = None

    @classmethod
    def from_run(cls, run: Run) -> Self:
        """Return the grid of a run, with arrival times from the core."""
        latitude, longitude, time = run.fuel_latitude, run.fuel_longitude, run.fuel_arrival_time()
        south, west = latitude[0] > latitude[-1], longitude[0] > longitude[-1]
        rows, columns = slice(None, None, -1 if south else 1), slice(None, None, -1 if west else 1)
        known = None
        if run.has(burned_fraction.FIELD):
            known = lambda moment: burned_fraction.at(run, moment)[rows, columns]  # noqa: E731
        return cls(latitude[rows], longitude[columns], np.asarray(time, np.float64)[rows, columns], known)

    @property
    def middle(self) -> float:
        """Central meridian, degrees east."""
        return float(self.longitude[0] + self.longitude[-1]) / 2

    @cached_property
    def cell(self) -> tuple[float, float]:
        """Cell width and height, m."""
        return areas.cell_size(self.latitude, self.longitude)

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Cell areas (ny, nx), m2."""
        return areas.cell_areas(self.latitude, self.longitude)

    @property
    def domain(self) -> float:
        """Total area, m2."""
        return float(self.areas.sum())

    def cells_at(
        self, latitude: NDArray[np.float64], longitude: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return rows and columns of the cells that contain points (degrees); -1 outside."""
        turned = areas.turned(longitude, self.middle)
        return _nearest(self.latitude, latitude), _nearest(self.longitude, turned)

    def burned(self, time: float) -> NDArray[np.floating] | NDArray[np.bool_]:
        """Return the burned fraction (ny, nx) at a model time (s).

        For a run without this field: True for cells whose centre the front has reached.
        """
        if self.fraction is not None:
            return self.fraction(time)
        return self.arrival <= time  # False for NaN


def fill_unburned(since: NDArray[np.float64]) -> NDArray[np.float64]:
    """Fill cells that never burn, so that the zero contour of `since` is the front.

    Parameters
    ----------
    since
        (ny, nx) arrival time minus time, s: 0 or less in burned cells, NaN in cells that never burn. A cell
        that never burns gets the negated mean of its burned neighbours, which places the front half-way
        between the two centres; without burned neighbours it gets a large positive value.
    """
    burned = np.where(since <= 0.0, since, 0.0)
    total, count = np.zeros_like(since), np.zeros(since.shape, int)
    for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        near = np.roll(burned, (dy, dx), (0, 1))
        total, count = total - near, count + (near < 0.0)
    missing = np.isnan(since)
    filled = np.where(missing, np.where(count > 0, total / np.maximum(count, 1), NEVER / 2), since)
    return np.maximum(filled, np.where(missing, 1e-3, -NEVER / 2))


def pad_axis(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Extend cell centres by one cell at each end."""
    edges = areas.edges(axis)
    return np.concatenate([[2 * edges[0] - axis[0]], axis, [2 * edges[-1] - axis[-1]]])


def _nearest(axis: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the index of the cell that contains each value, -1 outside; the axis ascends."""
    middles = (axis[1:] + axis[:-1]) / 2
    index = np.searchsorted(middles, at)
    half = (axis[1] - axis[0]) / 2 if axis.size > 1 else np.inf
    return np.where((at < axis[0] - half) | (at > axis[-1] + half), -1, index)
