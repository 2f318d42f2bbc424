"""Measures of all resources for a query: distance, minutes, cost, delivery, and reasons to omit them."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .distance import covers, distance_km
from .query import Query
from .records import AIR, DETOUR
from .station_file import StationFile

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

COVERAGE = ("time", "radius", "area")
"""Kinds of response areas, by their number in `Measures.coverage`."""

_MOST = 10**10  # cents and kg/h


@dataclass(frozen=True)
class Measures:
    """Values (n,) of all resources, each for all units of a row; NaN: unknown.

    Attributes
    ----------
    coverage
        Index into `COVERAGE`.
    cents, kg_h
        Cost rounded to cents, and delivery rounded down to kg/h, for exact sums; 0: unknown.
    tests
        Reasons to omit resources, each with its mask (n,); the most evident first.
    """

    distance_km: Array
    minutes: Array
    cost: Array
    tonnes_per_hour: Array
    coverage: NDArray[np.int64]
    cents: NDArray[np.int64]
    kg_h: NDArray[np.int64]
    tests: tuple[tuple[str, Mask], ...]


def measure(station_file: StationFile, query: Query) -> Measures:
    """Measure all resources for a query."""
    columns, codes = station_file.columns, station_file.codes
    nothing = np.full(len(columns.id), np.nan)
    air = codes.kind.isin(AIR)
    far = nothing
    if query.near is not None:
        far = distance_km(*station_file.positions, query.near)[columns.station]
    way = np.where(air, 1.0, query.detour)
    minutes = travel_minutes(far, air, columns.speed_km_h, columns.mobilise_min, query.detour)
    cost = resource_costs(station_file, query.hours)
    tonnes = delivery_rates(station_file, query, far, way)
    coverage, covered = coverage_areas(station_file, query, far)
    return Measures(
        far,
        minutes,
        cost,
        tonnes,
        coverage,
        _whole(np.round(cost * 100.0)),
        _whole(np.floor(tonnes * 1000.0 + 1e-6)),
        tuple(_omission_tests(station_file, query, far, minutes, cost, tonnes, covered)),
    )


def travel_minutes(
    far_km: ArrayLike, air: ArrayLike, speed_km_h: Array, mobilise_min: Array, detour: float = DETOUR
) -> Array:
    """Compute the response time, min: getaway time and travel time, straight by air.

    NaN if the speed or the getaway time is NaN. All arguments broadcast.
    """
    way = np.asarray(far_km, np.float64) * np.where(air, 1.0, detour)
    return mobilise_min + 60.0 * way / speed_km_h


def shortest_minutes(station_file: StationFile, near: tuple[float, float]) -> Array:
    """Compute the shortest time (stations,), min, of the resources of each station; NaN: unknown."""
    columns, least = station_file.columns, np.full(len(station_file.stations), np.nan)
    far = distance_km(*station_file.positions, near)[columns.station]
    minutes = travel_minutes(far, station_file.codes.kind.isin(AIR), columns.speed_km_h, columns.mobilise_min)
    np.fmin.at(least, columns.station, minutes)
    return least


def resource_costs(station_file: StationFile, hours: float) -> Array:
    """Compute the cost (n,) of mobilisation and of hours of work; see `unit_cost`."""
    columns = station_file.columns
    return columns.count * unit_cost(columns.cost_mobilise, columns.cost_hour, columns.cost_day, hours)


def unit_cost(mobilise: Array, hour: Array, day: Array, hours: float) -> Array:
    """Compute the cost (n,) of one unit: mobilisation, and work by the hour, or by the day.

    Without a rate per hour the rate per day applies. A missing cost of mobilisation counts as 0. NaN
    without a rate.
    """
    work = np.where(np.isnan(hour), day * np.ceil(hours / 24.0), hour * hours)
    return np.nan_to_num(mobilise) + work


def delivery_rates(station_file: StationFile, query: Query, far: Array, way: Array) -> Array:
    """Compute the delivery (n,), t/h, by round trips between the place and the refill point.

    Air tankers fill at their station, all others at `Query.refill_km`. 0 for resources without a load.
    """
    columns = station_file.columns
    home = station_file.codes.kind.isin(("airtanker",))
    one_way = np.where(home, far, query.refill_km) * way
    trip = 2.0 * one_way / columns.speed_km_h + query.turnaround_min / 60.0
    with np.errstate(divide="ignore"):
        return columns.count * np.where(np.isnan(columns.load_kg), 0.0, columns.load_kg / 1000.0 / trip)


def coverage_areas(station_file: StationFile, query: Query, far: Array) -> tuple[NDArray[np.int64], Mask]:
    """Return the kind of response area (n,) of each resource, and a mask (n,): the place is in it."""
    columns = station_file.columns
    drawn = np.zeros(len(station_file.stations), np.bool_)
    inside = np.zeros(len(station_file.stations), np.bool_)
    for area in station_file.areas:
        row = station_file.station_row[area.station]
        drawn[row] = True
        inside[row] |= query.near is not None and covers(area, *query.near)
    by_area, by_radius = drawn[columns.station], ~np.isnan(columns.radius_km)
    coverage = np.where(by_area, 2, np.where(by_radius, 1, 0))
    if query.near is None:
        return coverage, np.ones(len(coverage), np.bool_)
    within = ~by_radius | (far <= columns.radius_km)
    return coverage, np.where(by_area, inside[columns.station], within)


def _omission_tests(
    station_file: StationFile,
    query: Query,
    far: Array,
    minutes: Array,
    cost: Array,
    tonnes: Array,
    covered: Mask,
) -> list[tuple[str, Mask]]:
    codes, tests = station_file.codes, []
    for word, wanted, column in (
        ("kind", query.kinds, codes.kind),
        ("type", query.types, codes.type),
        ("mode", query.modes, codes.mode),
        ("staffing", query.staffing, codes.staffing),
    ):
        if wanted:
            tests.append((f"of another {word}", ~column.isin(wanted)))
    if query.night:
        tests.append(("not at night", ~station_file.columns.night))
    if query.at is not None:
        status = statuses(station_file, query.at)
        tests += [("of unknown status then", status < 0), ("not available then", status == 0)]
    if query.within_km is not None:
        tests.append((f"farther than {query.within_km:g} km", ~(far <= query.within_km)))
    tests.append(("outside of their response area", ~covered))
    if query.minutes is not None:
        tests += [
            ("of unknown speed or time to mobilise", np.isnan(minutes)),
            (f"later than {query.minutes:g} min", minutes > query.minutes),
        ]
    if query.tonnes_per_hour is not None:
        tests += [("of unknown delivery rate", np.isnan(tonnes)), ("carry nothing", tonnes <= 0.0)]
    if query.budget is not None or query.tonnes_per_hour is not None:
        other = ~codes.currency.isin((query.currency,))
        tests += [("of unknown cost", np.isnan(cost)), (f"not paid in {query.currency}", other)]
    return tests


def statuses(station_file: StationFile, at: datetime) -> NDArray[np.int64]:
    """Return the status (n,) of all resources at a time: 1 available, 0 not available, -1 unknown."""
    found = windows_at(station_file, at)
    known = found >= 0
    found[known] = station_file.windows.available[found[known]]
    return found


def windows_at(station_file: StationFile, at: datetime) -> NDArray[np.int64]:
    """Return the index (n,) into `StationFile.windows` that applies to each resource at a time; -1: none.

    If windows overlap, the last one to begin applies.
    """
    window_of_row, windows, time = (
        np.full(len(station_file.resources), -1, np.int64),
        station_file.windows,
        at.timestamp(),
    )
    now = (windows.begins <= time) & (time < windows.ends)
    window_of_row[windows.row[now]] = np.flatnonzero(now)  # the last window of a row wins
    return window_of_row


def _whole(values: Array) -> NDArray[np.int64]:
    return np.clip(np.nan_to_num(values), 0.0, _MOST).astype(np.int64)
