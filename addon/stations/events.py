"""Dated events of a run: its start and end, reports, ignition, flare-ups, arrival of the fire at places."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import datetime
from typing import Any, NamedTuple

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..run import burning, info, times
from ..run.labels import Label
from . import fire_arrival, ignition
from .fire_arrival import Arrivals
from .records import Station

FLARE_UP = 2.0
"""A flare-up exceeds this multiple of the mean heat release rate (by eye)."""


class Event(NamedTuple):
    """An event: its time, its text, and the name of its place (empty without one)."""

    time: datetime
    words: str
    place: str = ""


Place = Label | Station


def reports(facts: dict[str, Any], unit: str) -> list[tuple[str, str]]:
    """Return time and text of the start and the end of a run, and of reported areas in between.

    Parameters
    ----------
    facts
        Summary of the run (`info.gather`).
    unit
        Unit of areas.
    """
    reported = (
        (each["time"], f"{info.format_area(each['reported'], unit)} {unit} reported")
        for each in facts["reported"]
        if each["run"] is not None
    )
    at = facts["times"]
    return [(at["first"], "the run begins"), *reported, (at["last"], "the run ends")]


def arrivals(run: Run, places: Iterable[Place], found: Arrivals) -> list[Event]:
    """Return the arrival of the run's fire at places that it reaches."""
    return [
        Event(times.utc(run, float(time)), f"the fire reaches {place.name}", place.name)
        for place, time in zip(places, found.time, strict=True)
        if time == time  # NaN: the fire does not arrive
    ]


def arrivals_at(run: Run, places: Sequence[Place]) -> list[Event]:
    """Compute the arrival of the run's fire at places."""
    if not places:
        return []
    latitude, longitude = ([getattr(each, axis) for each in places] for axis in ("latitude", "longitude"))
    return arrivals(run, places, fire_arrival.sample(run, latitude, longitude))


def ignitions(run: Run) -> list[Event]:
    """Return the time at which the ignition point, or the nearest cell that burns, begins to burn."""
    found = ignition.find(run)
    if found is None:
        return []
    (latitude, longitude), _ = found
    time = float(fire_arrival.sample(run, [latitude], [longitude]).nearest_time[0])
    return [Event(times.utc(run, time), "ignition")] if np.isfinite(time) else []


def flare_ups(run: Run) -> list[Event]:
    """Return flare-ups: times of the run at which its heat release rate peaks (see `peaks`)."""
    area = burning.model_cell_areas(run)
    rate = np.array([np.sum(np.maximum(run.heat_flux(k), 0.0) * area) for k in range(len(run.times))])
    return [
        Event(times.utc(run, float(run.times[k])), f"flare-up, {rate[k] / 1e9:.3g} GW") for k in peaks(rate)
    ]


def peaks(rate: NDArray[np.float64]) -> list[int]:
    """Find the index of the maximum of each period in which a rate (n,) exceeds `FLARE_UP` times its mean."""
    above = rate > FLARE_UP * np.mean(rate) if len(rate) else np.zeros(0, np.bool_)
    edges = np.flatnonzero(np.diff(above.astype(np.int8), prepend=0, append=0))
    return [int(start + np.argmax(rate[start:end])) for start, end in edges.reshape(-1, 2)]
