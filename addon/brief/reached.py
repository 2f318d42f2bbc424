"""Fire arrival at the places of the page until the end of the run (see `stations.fire_arrival`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike

from ..stations import fire_arrival

State = Literal["reached", "before", "never", "outside"]
_STATES: dict[int, State] = {
    fire_arrival.REACHED: "reached",
    fire_arrival.BEFORE: "before",
    fire_arrival.NEVER: "never",
    fire_arrival.OUTSIDE: "outside",
}


@dataclass(frozen=True)
class Reached:
    """Arrival of the fire at a place.

    Attributes
    ----------
    state
        "reached" during the run; "before" its first time; "never" until its last; "outside" the grid.
    span
        Model times (s) for "reached", otherwise None: arrival time, earliest and latest (see
        `fire_arrival.Arrivals`).
    distance
        For "never", the distance to the nearest burning cell, m; None for other states, or without fire.
    """

    state: State
    span: tuple[float, float, float] | None = None
    distance: float | None = None

    @property
    def time(self) -> float | None:
        """Model time (s) for "reached", otherwise None."""
        return self.span[0] if self.span else None


def find(run: Run, latitude: ArrayLike, longitude: ArrayLike) -> list[Reached]:
    """Find the arrival of the fire at places (n,), degrees north and east."""
    latitude, longitude = (np.atleast_1d(np.asarray(each, np.float64)) for each in (latitude, longitude))
    if not latitude.size:
        return []
    found = fire_arrival.sample(run, latitude, longitude, until=float(run.times[-1]))
    return [_reached(found, index) for index in range(len(latitude))]


def _reached(found: fire_arrival.Arrivals, index: int) -> Reached:
    state = _STATES[int(found.state[index])]
    if state == "reached":
        time, earliest, latest = (float(each[index]) for each in (found.time, found.earliest, found.latest))
        return Reached(state, (time, earliest, latest))
    away = 1000.0 * float(found.nearest_km[index])
    return Reached(state, None, away if state == "never" and np.isfinite(away) else None)
