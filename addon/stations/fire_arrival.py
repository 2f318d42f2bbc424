"""Fire arrival: the time at which the fire of a run reaches a point, with its earliest and latest bound.

The front is the same as for flames and scores: it moves at constant speed between two cell centres, and a
front that has stopped is half-way between them (`run.arrival_grid.fill_unburned`).
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

import numpy as np
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import ecef
from ..run import front, times, zone
from ..run.arrival_grid import ArrivalGrid, fill_unburned
from ..run.front import Reach
from .distance import distance_km

Array = NDArray[np.float64]

OUTSIDE, NOT_REACHED, BEFORE, REACHED = range(4)
STATES = ("outside of the run", "not reached", "burned before the run", "reached")
"""States of a point; "not reached" holds until the end of the run."""

ARRIVAL_FIELD = "fuel_arrival_time"
_SIMILAR = 1.005  # ratio of chords within which the shorter geodesic can have the longer chord


@dataclass(frozen=True)
class Arrivals:
    """Arrival of the fire at points (n,).

    Attributes
    ----------
    state
        Index into `STATES`.
    time, earliest, latest
        Model times, s since the start of the run; NaN if the fire does not arrive. The bounds are the
        earliest and the latest arrival at the four cell centres around the point. For a run without the field
        `fuel_arrival_time` these are cells of the model, and one output interval is added on both sides. If
        one of the cells never burns, the front stops near the point, and the latest time is the end of the
        run.
    nearest_km, nearest_time
        Distance to the nearest cell that burns, km, and its arrival time: 0 and `time` if the fire reaches
        the point. Cells without fuel, such as cells of buildings, do not burn. NaN without a fire.
    """

    state: NDArray[np.int64]
    time: Array
    earliest: Array
    latest: Array
    nearest_km: Array
    nearest_time: Array

    def utc(self, run: Run, index: int) -> tuple[datetime, datetime, datetime] | None:
        """Return time, earliest and latest time of a point, UTC; None if the fire does not arrive."""
        if np.isnan(self.time[index]):
            return None
        first, second, third = (
            times.utc(run, float(each[index])) for each in (self.time, self.earliest, self.latest)
        )
        return first, second, third


def sample(run: Run, latitude: ArrayLike, longitude: ArrayLike, until: float | None = None) -> Arrivals:
    """Sample the arrival of a run's fire at points (n,), degrees north and east.

    Parameters
    ----------
    until
        Last model time that counts, s; by default the last time of the run.
    """
    cells = ArrivalGrid.from_run(run)
    grid = _Corners.from_reach(front.reach(run), latitude, longitude)
    end = float(run.times[-1]) if until is None else until
    since = bilinear(fill_unburned(grid.field - end), grid.row, grid.column)
    burned = grid.inside & (since <= 0.0) & np.isfinite(grid.time)
    time = np.where(burned, grid.time, np.nan)
    earliest, latest = grid.earliest, grid.latest
    if not run.has(ARRIVAL_FIELD):
        earliest, latest = _widen_to_model(run, latitude, longitude, earliest, latest)
    latest = np.where(grid.stops, np.maximum(latest, end), latest)
    state = np.where(burned, np.where(time < run.times[0], BEFORE, REACHED), NOT_REACHED)
    near, near_time = _nearest(cells, latitude, longitude, ~burned, end)
    return Arrivals(
        np.where(grid.inside, state, OUTSIDE),
        time,
        np.where(burned, np.minimum(earliest, time), np.nan),
        np.where(burned, np.maximum(latest, time), np.nan),
        np.where(burned, 0.0, near),
        np.where(burned, time, near_time),
    )


def format_time(run: Run, seconds: float) -> str:
    """Format a model time, s, in the time zone of the run."""
    return times.text(times.utc(run, seconds), zone.time_zone(run))


def first_burned_point(run: Run) -> tuple[float, float] | None:
    """Return the mean position of the fuel cells that burn first, degrees; None without a fire."""
    grid = ArrivalGrid.from_run(run)
    if not np.isfinite(grid.arrival).any():
        return None
    row, column = np.nonzero(grid.arrival == np.nanmin(grid.arrival))
    return float(grid.latitude[row].mean()), float(grid.longitude[column].mean())


def _nearest(
    grid: ArrivalGrid, latitude: ArrayLike, longitude: ArrayLike, wanted: NDArray[np.bool_], end: float
) -> tuple[Array, Array]:
    """Return the distance (n,), km, to the nearest cell that burns by `end`, and its time.

    Both are NaN for points that are not `wanted`.
    """
    burned = grid.arrival <= end
    far, time = (np.full(wanted.shape, np.nan) for _ in range(2))
    if not burned.any():
        return far, time
    padded = np.pad(burned, 1)
    inner = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    row, column = np.nonzero(burned & ~inner)  # the nearest cell is at the edge of the burned area
    y, x = np.asarray(latitude, np.float64), np.asarray(longitude, np.float64)
    cells, points = _earth_centred(grid.latitude[row], grid.longitude[column]), _earth_centred(y, x)
    for k in np.flatnonzero(wanted):
        chord = np.linalg.norm(cells - points[k], axis=1)
        some = np.flatnonzero(chord <= chord.min() * _SIMILAR)
        south, west = grid.latitude[row[some]], grid.longitude[column[some]]
        distance = distance_km(south, west, (float(y[k]), float(x[k])))
        at = int(np.argmin(distance))
        far[k], time[k] = distance[at], grid.arrival[row[some[at]], column[some[at]]]
    return far, time


def _earth_centred(latitude: Array, longitude: Array) -> Array:
    """Convert degrees to Earth-centred positions (n, 3) on the ellipsoid, m."""
    return ecef(np.radians(latitude), np.radians(longitude), np.zeros(len(latitude)))


@dataclass(frozen=True)
class _Corners:
    """Arrival times on a grid with a margin, and bounds from the four cells around each point (n,)."""

    field: Array
    row: Array
    column: Array
    inside: NDArray[np.bool_]
    time: Array
    earliest: Array
    latest: Array
    stops: NDArray[np.bool_]

    @classmethod
    def from_reach(cls, fire: Reach, latitude: ArrayLike, longitude: ArrayLike) -> _Corners:
        """Find the cells; the time is bilinear between the cells that burn."""
        field = fire.arrival
        row, column = fire.at(latitude, longitude)
        inside = (row >= 0.5) & (row <= len(field) - 1.5)  # within the edges of cells, half-way to the margin
        inside &= (column >= 0.5) & (column <= field.shape[1] - 1.5)
        row, column = np.where(inside, row, 0.0), np.where(inside, column, 0.0)
        low = [
            np.minimum(at.astype(np.int64), n - 2) for at, n in zip((row, column), field.shape, strict=True)
        ]
        v, u = row - low[0], column - low[1]
        corner = np.stack([field[low[0] + i, low[1] + j] for i in (0, 1) for j in (0, 1)])
        weight = np.stack([(v if i else 1 - v) * (u if j else 1 - u) for i in (0, 1) for j in (0, 1)])
        weight[:, ~inside] = 0.0
        burns = np.isfinite(corner) & (weight > 0.0)
        total = np.where(burns, weight, 0.0).sum(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            time = np.where(burns, corner * weight, 0.0).sum(axis=0) / total
        return cls(
            field,
            row,
            column,
            inside,
            np.where(total > 0.0, time, np.nan),
            np.where(burns, corner, np.inf).min(axis=0),
            np.where(burns, corner, -np.inf).max(axis=0),
            (~np.isfinite(corner) & (weight > 0.0)).any(axis=0),
        )


def _widen_to_model(
    run: Run, latitude: ArrayLike, longitude: ArrayLike, earliest: Array, latest: Array
) -> tuple[Array, Array]:
    """Widen the bounds to the surrounding cells of the model, and by one output interval."""
    order = [slice(None, None, -1 if axis[0] > axis[-1] else 1) for axis in (run.latitude, run.longitude)]
    time = np.asarray(run.arrival_time(), np.float64)[order[0], order[1]]
    grid = ArrivalGrid(run.latitude[order[0]], run.longitude[order[1]], time)
    model = _Corners.from_reach(Reach(grid), latitude, longitude)
    step = float(np.max(np.diff(run.times), initial=0.0))
    return np.minimum(earliest, model.earliest) - step, np.maximum(latest, model.latest) + step
