"""Search among stations alone, by distance."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .distance import distance_km
from .query import Query
from .records import Station
from .station_file import StationFile


@dataclass(frozen=True)
class StationMatch:
    """A station that answers a query, and its straight distance, km; None without a place to go to."""

    station: Station
    distance_km: float | None


@dataclass(frozen=True)
class Found:
    """Stations by distance, then by number, and how many each reason left out."""

    matches: list[StationMatch]
    left_out: dict[str, int] = field(default_factory=dict)


def survey(station_file: StationFile, query: Query) -> Found:
    """Stations within the query's distance; its conditions on resources are not looked at."""
    number = np.array([each.id for each in station_file.stations], np.int64)
    if query.near is None:
        order = np.argsort(number, kind="stable")
        return Found([StationMatch(station_file.stations[row], None) for row in order])
    far = distance_km(*station_file.positions, query.near)
    kept = np.ones(len(far), np.bool_) if query.within_km is None else far <= query.within_km
    rows = np.flatnonzero(kept)
    rows = rows[np.lexsort((number[rows], far[rows]))]
    left_out = {} if kept.all() else {f"farther than {query.within_km:g} km": int(np.count_nonzero(~kept))}
    return Found([StationMatch(station_file.stations[row], float(far[row])) for row in rows], left_out)
