"""Fire arrival at the places of the page until the end of the run (see `stations.fire_arrival`)."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike

from ..run.measure import Units
from ..stations import arrival_text, fire_arrival
from ..stations.arrival_text import ArrivalText
from . import units

State = Literal["reached", "before", "not_reached", "outside"]
_STATES: dict[int, State] = {
    fire_arrival.REACHED: "reached",
    fire_arrival.BEFORE: "before",
    fire_arrival.NOT_REACHED: "not_reached",
    fire_arrival.OUTSIDE: "outside",
}


@dataclass(frozen=True)
class Reached:
    """Arrival of the fire at a place.

    Attributes
    ----------
    state
        "reached" during the run; "before" its first time; "not_reached" until its last; "outside" the grid.
    text
        Its wording.
    time
        Model time (s) for "reached", otherwise None.
    distance
        For "not_reached", the distance to the nearest burning cell, m; otherwise, or without fire, None.
    """

    state: State
    text: ArrivalText
    time: float | None = None
    distance: float | None = None


def find(
    run: Run,
    latitude: ArrayLike,
    longitude: ArrayLike,
    zone: str,
    error: float | None = None,
    order: Units = "us",
) -> list[Reached]:
    """Find the arrival of the fire at places (n,), degrees north and east.

    Parameters
    ----------
    zone
        Time zone of the texts.
    error
        Mean absolute error of arrival times against observations, s; None: unknown.
    order
        Units that come first in distances.
    """
    distance = functools.partial(units.distance, units=order)
    latitude, longitude = (np.atleast_1d(np.asarray(each, np.float64)) for each in (latitude, longitude))
    if not latitude.size:
        return []
    found = fire_arrival.sample(run, latitude, longitude)
    return [_reached(run, found, index, zone, error, distance) for index in range(len(latitude))]


def _reached(
    run: Run,
    arrivals: fire_arrival.Arrivals,
    index: int,
    zone: str,
    error: float | None,
    distance: Callable[[float], str],
) -> Reached:
    state = _STATES[int(arrivals.state[index])]
    away = 1000.0 * float(arrivals.nearest_km[index])
    return Reached(
        state,
        arrival_text.describe(run, arrivals, index, zone, distance, error),
        float(arrivals.time[index]) if state == "reached" else None,
        away if state == "not_reached" and np.isfinite(away) else None,
    )
