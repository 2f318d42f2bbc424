"""Search: resources that match a query, with arrival time, cost and delivery.

Five terms of a query are defined as follows. Response area: the polygons of the station, otherwise the
radius of the resource, otherwise the area within the travel time of the query. Budget: mobilisation and hours
of work, summed over the set. Delivery rate: water or retardant that the set delivers by round trips, t/h.
Operational mode: one of `records.MODES`. Availability: the status at the time of the query.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import cover, measures
from .query import Query
from .records import Resource, Station
from .station_file import StationFile

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Match:
    """Resource that matches a query; None: unknown. Values include all units of its row.

    Attributes
    ----------
    distance_km
        Straight distance, km.
    minutes
        Response time, min: getaway time and travel time.
    cost
        Mobilisation and the hours of work of the query, in the currency of the resource.
    tonnes_per_hour
        Water or retardant delivered by round trips, t/h.
    coverage
        Kind of response area: ``area`` (a polygon), ``radius``, or ``time``.
    """

    resource: Resource
    station: Station
    distance_km: float | None
    minutes: float | None
    cost: float | None
    tonnes_per_hour: float | None
    coverage: str


@dataclass(frozen=True)
class ResourceMatches:
    """Result of a search.

    Attributes
    ----------
    matches
        By minutes, then by number; with a budget or a delivery rate, only the resources of the set.
    left_out
        Number of omitted resources by reason; the first reason of each resource counts.
    candidates
        Number of resources from which the set was chosen.
    shortfall
        Reason why no set delivers enough; empty if there is a set.
    """

    matches: list[Match]
    left_out: dict[str, int] = field(default_factory=dict)
    candidates: int = 0
    shortfall: str = ""

    @property
    def cost(self) -> float:
        """Sum of known costs."""
        return sum(each.cost or 0.0 for each in self.matches)

    @property
    def tonnes_per_hour(self) -> float:
        """Sum of known deliveries, t/h."""
        return sum(each.tonnes_per_hour or 0.0 for each in self.matches)


def find(station_file: StationFile, query: Query) -> list[Match]:
    """Find the resources that match a query, by minutes, then by number; `survey` also counts omissions."""
    return survey(station_file, query).matches


def survey(station_file: StationFile, query: Query) -> ResourceMatches:
    """Find the resources that match a query, and count the omitted resources by reason.

    Without budget and delivery rate these are all resources that meet the other conditions. With a delivery
    rate it is the cheapest set that delivers it (`cover.cheapest`), within the budget if there is one. With a
    budget only, these are the earliest resources that the budget pays for.
    """
    measured = measures.measure(station_file, query)
    left_out: dict[str, int] = {}
    kept = np.ones(len(station_file.resources), np.bool_)
    for reason, fails in measured.tests:
        out = kept & fails
        if out.any():
            left_out[reason] = int(np.count_nonzero(out))
            kept &= ~fails
    rows = np.flatnonzero(kept)
    rows = rows[np.lexsort((station_file.columns.id[rows], measured.minutes[rows]))]  # NaN comes last
    chosen, shortfall = _set(rows, measured, query)
    is_set = query.tonnes_per_hour is not None or query.budget is not None
    candidates = len(rows) if is_set else 0
    return ResourceMatches(_matches(station_file, measured, chosen), left_out, candidates, shortfall)


def _set(rows: NDArray[np.int64], measured: measures.Measures, query: Query) -> tuple[NDArray[np.int64], str]:
    """Choose the rows of the set for the budget and the delivery rate of a query; else return the reason."""
    if query.tonnes_per_hour is None:
        return (rows, "") if query.budget is None else (_first(rows, measured.cents[rows], query.budget), "")
    by_id = np.sort(rows)
    need = int(np.ceil(query.tonnes_per_hour * 1000.0 - 1e-9))
    chosen = cover.cheapest(measured.cents[by_id], measured.kg_h[by_id], need)
    none = rows[:0]
    if chosen is None:
        most = measured.kg_h[by_id].sum() / 1000.0
        return none, f"all {len(rows)} together deliver {most:.1f} t/h, less than {query.tonnes_per_hour:g}"
    cost = measured.cents[by_id[chosen]].sum() / 100.0
    if query.budget is not None and cost > query.budget:
        return none, (f"the cheapest set costs {cost:,.2f} {query.currency}, more than {query.budget:,.2f}")
    return rows[np.isin(rows, by_id[chosen])], ""


def _first(rows: NDArray[np.int64], cents: NDArray[np.int64], budget: float) -> NDArray[np.int64]:
    """Select rows in their order while the budget pays for them; rows that are too expensive are skipped."""
    left, taken = round(budget * 100), []
    for row, cost in zip(rows.tolist(), cents.tolist(), strict=True):
        if cost <= left:
            taken.append(row)
            left -= cost
    return np.array(taken, np.int64)


def _matches(station_file: StationFile, measured: measures.Measures, rows: NDArray[np.int64]) -> list[Match]:
    """Return the matches of rows, in their order."""
    values = (
        [None if value != value else value for value in column[rows].tolist()]
        for column in (measured.distance_km, measured.minutes, measured.cost, measured.tonnes_per_hour)
    )
    station, coverage = station_file.columns.station[rows].tolist(), measured.coverage[rows].tolist()
    return [
        Match(
            station_file.resources[row],
            station_file.stations[at],
            far,
            minutes,
            cost,
            tonnes,
            measures.COVERAGE[kind],
        )
        for row, at, kind, far, minutes, cost, tonnes in zip(
            rows.tolist(), station, coverage, *values, strict=True
        )
    ]
