"""Query: the conditions of a search."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from .records import DETOUR


@dataclass(frozen=True)
class Query:
    """What is looked for; None and empty values look for all.

    Attributes
    ----------
    near
        Place that resources go to, degrees north and east; distances, times and tonnage need it.
    within_km
        Greatest straight distance, km.
    minutes
        Greatest time from the order to the arrival, min.
    kinds, types, modes, staffing
        Kinds (``engine``), types without kind (``3``, ``VLAT``), operational modes, employment.
    night
        Only what works at night.
    at
        Time (UTC) at which its status is ``available``.
    tonnes_per_hour
        Water or retardant that the set has to deliver, t/h.
    budget
        Greatest cost of the set, in `currency`.
    currency
        Currency of costs; what costs another one is left out of sets.
    hours
        Hours of work that are paid, h.
    detour
        Length of roads by straight distance.
    refill_km
        Straight distance to the place of refilling, km; air tankers go back to their station.
    turnaround_min
        Time to fill and to discharge in each round trip, min.
    """

    near: tuple[float, float] | None = None
    within_km: float | None = None
    minutes: float | None = None
    kinds: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    modes: tuple[str, ...] = ()
    staffing: tuple[str, ...] = ()
    night: bool = False
    at: datetime | None = None
    tonnes_per_hour: float | None = None
    budget: float | None = None
    currency: str = "USD"
    hours: float = 12.0
    detour: float = DETOUR
    refill_km: float = 5.0
    turnaround_min: float = 10.0
