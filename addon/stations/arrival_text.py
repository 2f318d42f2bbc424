"""Wording of fire arrival at a place: the same in lists, signs, panels, and the briefing page."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..run import areas, times
from .fire_arrival import ARRIVAL_FIELD, BEFORE, NOT_REACHED, OUTSIDE, REACHED, Arrivals

NEAR = 1000.0
"""Distance (m) up to which an approach of the fire counts as near, so that its time is given. By eye."""


@dataclass(frozen=True)
class ArrivalText:
    """Wording of fire arrival at a place.

    Attributes
    ----------
    headline
        Arrival time, closest approach with its time, or "not reached" with the distance.
    note
        UTC and resolution of the time, or the period of the run; empty if there is none.
    """

    headline: str
    note: str

    def __str__(self) -> str:
        """Join headline and note."""
        return ", ".join(filter(None, (self.headline, self.note)))


def format_distance(metres: float) -> str:
    """Format a distance with two digits, rounded up: ``320 m``, ``4.3 km``, ``14 km``."""
    step = 10.0 if metres <= 990.0 else 100.0 if metres <= 9900.0 else 1000.0
    metres = step * math.ceil(round(metres / step, 6))
    if metres < 1000.0:
        return f"{metres:.0f} m"
    return f"{metres / 1000.0:.{1 if metres < 10_000.0 else 0}f} km"


def describe(
    run: Run,
    arrivals: Arrivals,
    index: int,
    zone: str,
    distance: Callable[[float], str] = format_distance,
    error: float | None = None,
) -> ArrivalText:
    """Describe the arrival of the fire at a place.

    Parameters
    ----------
    zone
        Time zone of the text.
    distance
        Format of a distance in metres.
    error
        Mean absolute error (s) of arrival times against observations; None: unknown, so that the note gives
        the resolution.
    """
    state = int(arrivals.state[index])
    first, last = (times.text(times.utc(run, float(run.times[k])), zone) for k in (0, -1))
    if state == BEFORE:
        return ArrivalText("burned before the run", f"by {first}")
    accuracy = format_resolution(run)
    if error is not None:
        accuracy = f"mean error {format_duration(error)} against observations"
    where = "outside the run" if state == OUTSIDE else "not reached"
    if math.isnan(arrivals.nearest_km[index]):
        return ArrivalText(where, f"no fire by {last}")
    when = times.utc(run, float(arrivals.nearest_time[index]))
    moment, note = times.text(when, zone), f"{when:%d %b %H:%M} UTC, {accuracy}"
    if state == REACHED:
        return ArrivalText(moment, note)
    metres = 1000.0 * float(arrivals.nearest_km[index])
    if metres <= NEAR and state == NOT_REACHED:
        return ArrivalText(f"within {distance(metres)} at {moment}", note)
    return ArrivalText(f"{where}, nearest fire {distance(metres)}", f"{first} to {last}")


def format_resolution(run: Run) -> str:
    """Describe the resolution of arrival times: ``at the model's cell of 370 m (fuel cell 74 m)``."""
    cell = _cell(run.latitude, run.longitude)
    if run.has(ARRIVAL_FIELD):
        fuel = _cell(run.fuel_latitude, run.fuel_longitude)
        return f"at the model's cell of {cell}" + ("" if fuel == cell else f" (fuel cell {fuel})")
    steps = [float(b - a) for a, b in zip(run.times[:-1], run.times[1:], strict=True)]
    every = f", output every {format_duration(max(steps))}" if steps else ""
    return f"at the model's cell of {cell}{every}"


def format_duration(seconds: float) -> str:
    """Format a duration: ``40 s``, ``41 min``, ``2.5 h``."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def _cell(latitude: NDArray[np.float64], longitude: NDArray[np.float64]) -> str:
    width, height = areas.cell_size(latitude, longitude)
    return f"{max(width, height):.0f} m"
