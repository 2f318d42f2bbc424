"""When the fire of a run reaches places of the page: by `places.ahead`, until the run's last time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike

from ..places import ahead

State = Literal["reached", "before", "never", "outside"]
_STATES: dict[int, State] = {
    ahead.REACHED: "reached",
    ahead.BEFORE: "before",
    ahead.NEVER: "never",
    ahead.OUTSIDE: "outside",
}


@dataclass(frozen=True)
class Reached:
    """How a fire reaches a place.

    Attributes
    ----------
    state
        "reached"; "before" the run's first time; "never" until its last; "outside" of its grid.
    span
        Model times (s) of "reached", else None: its time, the earliest and the latest (see `ahead.Arrivals`).
    distance
        To the nearest cell that burns, m, of "never"; else None, and where nothing burns.
    """

    state: State
    span: tuple[float, float, float] | None = None
    distance: float | None = None

    @property
    def time(self) -> float | None:
        """Model time (s) of "reached", else None."""
        return self.span[0] if self.span else None


def find(run: Run, latitude: ArrayLike, longitude: ArrayLike) -> list[Reached]:
    """How the fire reaches places (n,), degrees north and east."""
    latitude, longitude = (np.atleast_1d(np.asarray(each, np.float64)) for each in (latitude, longitude))
    if not latitude.size:
        return []
    found = ahead.sample(run, latitude, longitude, until=float(run.times[-1]))
    return [_reached(found, index) for index in range(len(latitude))]


def _reached(found: ahead.Arrivals, index: int) -> Reached:
    state = _STATES[int(found.state[index])]
    if state == "reached":
        time, earliest, latest = (float(each[index]) for each in (found.time, found.earliest, found.latest))
        return Reached(state, (time, earliest, latest))
    away = 1000.0 * float(found.nearest_km[index])
    return Reached(state, None, away if state == "never" and np.isfinite(away) else None)
