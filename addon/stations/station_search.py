"""Search for stations by distance, without conditions on resources."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .distance import distance_km
from .query import Query
from .records import Station
from .station_file import StationFile


@dataclass(frozen=True)
class StationMatch:
    """Station that matches a query, and its straight distance, km; None without a destination."""

    station: Station
    distance_km: float | None


@dataclass(frozen=True)
class StationMatches:
    """Stations by distance, then by number, and the number of omitted stations by reason."""

    matches: list[StationMatch]
    left_out: dict[str, int] = field(default_factory=dict)


def survey(station_file: StationFile, query: Query) -> StationMatches:
    """Find the stations within the distance of a query; its conditions on resources are ignored."""
    number = np.array([each.id for each in station_file.stations], np.int64)
    if query.near is None:
        order = np.argsort(number, kind="stable")
        return StationMatches([StationMatch(station_file.stations[row], None) for row in order])
    far = distance_km(*station_file.positions, query.near)
    kept = np.ones(len(far), np.bool_) if query.within_km is None else far <= query.within_km
    rows = np.flatnonzero(kept)
    rows = rows[np.lexsort((number[rows], far[rows]))]
    left_out = {} if kept.all() else {f"farther than {query.within_km:g} km": int(np.count_nonzero(~kept))}
    return StationMatches(
        [StationMatch(station_file.stations[row], float(far[row])) for row in rows], left_out
    )
