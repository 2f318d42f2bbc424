"""Places on the grid of an ensemble, and the members that have burned them at a time.

Fronts are drawn as in `run.front`: they move at constant speed between two cell centres.
"""

from __future__ import annotations

import functools

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ...run.arrival_grid import ArrivalGrid, fill_unburned
from ...run.front import Reach
from .ensemble import Ensemble

_CACHED = 4  # combinations of members, for the next frame


class Places:
    """Places (n,) on the grid of an ensemble.

    Attributes
    ----------
    inside
        (n,) True within the cells of the grid.
    """

    def __init__(self, ensemble: Ensemble, latitude: ArrayLike, longitude: ArrayLike) -> None:
        self.ensemble = ensemble
        row, column = self._reach(0).at(latitude, longitude)
        _, rows, columns = ensemble.shape
        with np.errstate(invalid="ignore"):
            self.inside = (np.abs(row - 0.5 * (rows + 1)) <= 0.5 * rows) & (
                np.abs(column - 0.5 * (columns + 1)) <= 0.5 * columns
            )
        self._row, self._column = (np.where(self.inside, at, 0.0) for at in (row, column))

    def burned(self, member: int, time: float) -> NDArray[np.bool_]:
        """Find the places that a member has burned by a time, s since the issue time."""
        arrival = self._reach(member).arrival
        burned = np.zeros(len(self.inside), np.bool_)
        if not (reached := arrival <= time).any():
            return burned
        box = [
            (max(int(lines[0]) - 2, 0), int(lines[-1]) + 3)
            for lines in (np.flatnonzero(reached.any(axis)) for axis in (1, 0))
        ]
        (south, north), (west, east) = box
        near = self.inside & (self._row >= south) & (self._row <= north - 1)
        near &= (self._column >= west) & (self._column <= east - 1)
        since = fill_unburned(arrival[south:north, west:east] - time)
        burned[near] = bilinear(since, self._row[near] - south, self._column[near] - west) <= 0.0
        return burned

    def simulated(self, members: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Find the places that all of the given members have simulated."""
        simulated = _simulated(self.ensemble, tuple(members.tolist()))
        _, rows, columns = self.ensemble.shape
        row = np.clip(np.rint(self._row).astype(np.int64) - 1, 0, rows - 1)
        column = np.clip(np.rint(self._column).astype(np.int64) - 1, 0, columns - 1)
        return self.inside & simulated[row, column]

    def _reach(self, member: int) -> Reach:
        """Return the burned area of a member."""
        return reach(self.ensemble, self.ensemble.arrival(member))


def reach(ensemble: Ensemble, arrival: NDArray[np.floating]) -> Reach:
    """Return the burned area by arrival times (ny, nx) on the grid of an ensemble, on ascending axes."""
    turn = _ascending(ensemble)
    times = arrival[turn].astype(np.float64)
    times[~np.isfinite(times)] = np.nan
    return Reach(ArrivalGrid(ensemble.latitude[turn[0]], ensemble.longitude[turn[1]], times))


@functools.lru_cache(maxsize=_CACHED)
def _simulated(ensemble: Ensemble, members: tuple[int, ...]) -> NDArray[np.bool_]:
    """Find the cells (ny, nx), on ascending axes, that all of these members have simulated."""
    _, *shape = ensemble.shape
    simulated = np.empty(shape, np.bool_)
    for rows, arrival in ensemble.blocks():
        simulated[rows] = ~np.isnan(arrival[list(members)]).any(axis=0)
    return simulated[_ascending(ensemble)]


def _ascending(ensemble: Ensemble) -> tuple[slice, slice]:
    """Return the order of rows and columns in which coordinates ascend."""
    axes = ensemble.latitude, ensemble.longitude
    north, east = (slice(None, None, -1 if axis[0] > axis[-1] else 1) for axis in axes)
    return north, east
