"""Query: the conditions of a search."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from .records import DETOUR


@dataclass(frozen=True)
class Query:
    """Conditions of a search; None and empty values match everything.

    Attributes
    ----------
    near
        Destination of the resources, degrees north and east; distances, times and delivery need it.
    within_km
        Maximum straight distance, km.
    minutes
        Maximum time from the order to the arrival, min.
    kinds, types, modes, staffing
        Kinds (``engine``), types without kind (``3``, ``VLAT``), operational modes, employment.
    night
        Only resources that work at night.
    at
        Time (UTC) at which the status must be ``available``.
    tonnes_per_hour
        Minimum delivery of water or retardant by the set, t/h.
    budget
        Maximum cost of the set, in `currency`.
    currency
        Currency of costs; sets omit resources with costs in another currency.
    hours
        Paid hours of work, h.
    detour
        Ratio of road length to straight distance.
    refill_km
        Straight distance to the refill point, km; air tankers return to their station.
    turnaround_min
        Time to fill and discharge in each round trip, min.
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
