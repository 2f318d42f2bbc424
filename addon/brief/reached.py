"""When the fire of a run reaches places: at a time, before the run began, never, or outside of its grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import metres_per_degree
from ..run import areas
from ..run.front import reach
from ..run.score.grid import ScoreGrid

State = Literal["reached", "before", "never", "outside"]
_TOGETHER = 2_000_000  # distances computed at once


@dataclass(frozen=True)
class Reached:
    """How a fire reaches a place.

    Attributes
    ----------
    state
        "reached"; "before" the run's first time; "never" until its last; "outside" of its grid.
    time
        Model time (s) of "reached", else None.
    distance
        From the front at the run's last time, m, of "never"; else None, and where nothing burned.
    """

    state: State
    time: float | None = None
    distance: float | None = None


def find(run: Run, latitude: ArrayLike, longitude: ArrayLike) -> list[Reached]:
    """How the fire reaches places (degrees): the arrival time of the fuel cell that holds each.

    Distances are to points of the front that are at most a fuel cell apart.
    """
    latitude = np.atleast_1d(np.asarray(latitude, np.float64))
    longitude = np.atleast_1d(np.asarray(longitude, np.float64))
    if not latitude.size:
        return []
    grid, first, last = ScoreGrid.of(run), float(run.times[0]), float(run.times[-1])
    row, column = grid.at(latitude, longitude)
    inside = (row >= 0) & (column >= 0)
    arrival = np.where(inside, grid.arrival[row, column], np.nan)
    away = _distances(run, latitude, longitude)
    return [_reached(*each, first, last) for each in zip(inside, arrival, away, strict=True)]


def _reached(inside: bool, arrival: float, away: float, first: float, last: float) -> Reached:
    if not inside:
        return Reached("outside")
    if arrival < first:
        return Reached("before")
    if arrival <= last:
        return Reached("reached", float(arrival))
    return Reached("never", None, float(away) if np.isfinite(away) else None)


def _distances(run: Run, latitude: NDArray, longitude: NDArray) -> NDArray[np.float64]:
    """Distance (n,), m, of places from the front at the run's last time; infinite without a front."""
    fire = reach(run)
    front_latitude, front_longitude, _ = fire.line(float(run.times[-1]))
    nearest = np.full(len(latitude), np.inf)
    if not len(front_latitude):
        return nearest
    longitude = areas.turned(longitude, float(front_longitude.mean()))
    north, east = metres_per_degree(float(front_latitude.mean()))
    step = max(_TOGETHER // len(front_latitude), 1)
    for begin in range(0, len(latitude), step):
        here = slice(begin, begin + step)
        y = (latitude[here, None] - front_latitude) * north
        x = (longitude[here, None] - front_longitude) * east
        nearest[here] = np.hypot(x, y).min(axis=1)
    return nearest
