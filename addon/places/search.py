"""Search: which resources answer a query, when they are there, what they cost and what they deliver."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime

from .records import Resource, Station
from .store import Places


@dataclass(frozen=True)
class Query:
    """What is looked for; None and empty values look for all.

    Attributes
    ----------
    near
        Place that resources go to, degrees north and east; needed by distances and times.
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
        Greatest cost of the set.
    hours
        Hours of work that are paid, h.
    detour
        Length of roads by straight distance.
    refill_km
        Distance of the place of refilling, km; air tankers go back to their station.
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
    hours: float = 12.0
    detour: float = 1.4
    refill_km: float = 5.0
    turnaround_min: float = 10.0


@dataclass(frozen=True)
class Match:
    """A resource that answers a query; None is not known. Values are of all units of its row.

    Attributes
    ----------
    distance_km
        Straight distance, km.
    minutes
        Minutes from the order to the arrival: mobilising and the way.
    cost
        Mobilising and the query's hours of work, in the resource's currency.
    tonnes_per_hour
        Water or retardant delivered by round trips, t/h.
    coverage
        What its area of coverage is: ``area`` (a polygon), ``radius``, or ``time``.
    """

    resource: Resource
    station: Station
    distance_km: float | None
    minutes: float | None
    cost: float | None
    tonnes_per_hour: float | None
    coverage: str


@dataclass(frozen=True)
class Found:
    """Matches by arrival, how many resources each reason left out, and why a set falls short."""

    matches: list[Match]
    left_out: dict[str, int] = field(default_factory=dict)
    shortfall: str = ""


def find(places: Places, query: Query) -> list[Match]:
    """Resources that answer a query, by minutes, then by number; see `survey` for what was left out."""
    return survey(places, query).matches


def survey(places: Places, query: Query) -> Found:
    """Resources that answer a query, and how many each reason left out."""
    raise NotImplementedError
