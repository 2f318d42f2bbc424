"""Search: which resources answer a query, when they are there, what they cost and what they deliver.

Five words of a query have one meaning each. Area of coverage: the polygons of the station's areas, else the
resource's radius, else what it reaches within the query's minutes. Budget: mobilising and the hours of work,
summed over the set. Tonnage: water or retardant that the set delivers by round trips, t/h. Operational mode:
one of `records.MODES`. Availability: the status at the query's time.
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
    """Answer of a search.

    Attributes
    ----------
    matches
        By minutes, then by number; where the query has a budget or a tonnage, those of the set alone.
    left_out
        Number of resources that each reason left out; the first reason of each counts.
    candidates
        Number of resources that the set was chosen from.
    shortfall
        Why there is no set that delivers enough; empty where there is one.
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
    """Resources that answer a query, by minutes, then by number; see `survey` for what was left out."""
    return survey(station_file, query).matches


def survey(station_file: StationFile, query: Query) -> Found:
    """Resources that answer a query, and how many each reason left out.

    Without budget and tonnage these are all that pass the other conditions. With a tonnage it is the cheapest
    set that delivers it, by `cover.cheapest`, within the budget if there is one. With a budget alone it is
    what arrives first, as far as the budget goes.
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
    return Found(_matches(station_file, measured, chosen), left_out, candidates, shortfall)


def _set(rows: NDArray[np.int64], measured: measures.Measures, query: Query) -> tuple[NDArray[np.int64], str]:
    """Rows of the set that the budget and the tonnage of a query choose, and why there is none."""
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
    """Rows in their order that a budget still pays; one that it does not pay is passed over."""
    left, taken = round(budget * 100), []
    for row, cost in zip(rows.tolist(), cents.tolist(), strict=True):
        if cost <= left:
            taken.append(row)
            left -= cost
    return np.array(taken, np.int64)


def _matches(station_file: StationFile, measured: measures.Measures, rows: NDArray[np.int64]) -> list[Match]:
    """Matches of rows, in their order."""
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
