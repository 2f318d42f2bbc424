"""List of stations: stations with a resource that matches a query, and the details of a station."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from . import search, station_search
from .describe import count_types
from .query import Query
from .records import EXERCISE, Resource, Station
from .station_file import StationFile

_TYPES = 6  # types of resources that are named for a station


@dataclass(frozen=True)
class StationRow:
    """A station of a list; None: unknown.

    Attributes
    ----------
    distance_km
        Straight distance to the place of the query, km.
    minutes
        Shortest time from the order to the arrival of a resource that matches the query, min.
    exercise
        True if the station or any of its resources was invented for an exercise.
    """

    station: Station
    distance_km: float | None
    minutes: float | None
    exercise: bool


@dataclass(frozen=True)
class Listing:
    """Rows by minutes, or by distance; and the number of omitted rows by reason."""

    rows: list[StationRow]
    left_out: dict[str, int] = field(default_factory=dict)


def station_key(station: Station) -> str:
    """Return the permanent identifier of a station: its number in the file, and its name."""
    return f"{station.id} {station.name}"


def find(listed: Sequence[Station], wanted: str) -> Station | None:
    """Find the station of a key; if number and name do not match, the only station of this name."""
    same = [each for each in listed if station_key(each) == wanted]
    same = same or [each for each in listed if each.name == wanted.partition(" ")[2]]
    return same[0] if len(same) == 1 else None


def survey(station_file: StationFile, query: Query) -> Listing:
    """List the stations with a resource that matches a query; all stations if it has no such condition."""
    own = _exercise_stations(station_file)
    if not _has_resource_condition(query) or not station_file.resources:
        least = _shortest_times(search.find(station_file, query)) if station_file.resources else {}
        matched = station_search.survey(station_file, query)
        rows = [
            StationRow(
                each.station, each.distance_km, least.get(each.station.id), _exercise(each.station, own)
            )
            for each in matched.matches
        ]
        return Listing(rows, matched.left_out)
    answer = search.survey(station_file, query)
    least = _shortest_times(answer.matches)
    first = {each.station.id: each for each in reversed(answer.matches)}
    order = {each.station.id: None for each in answer.matches}
    rows = [
        StationRow(first[n].station, first[n].distance_km, least.get(n), _exercise(first[n].station, own))
        for n in order
    ]
    return Listing(rows, answer.left_out)


def facts(station_file: StationFile, station: Station) -> list[tuple[str, str]]:
    """Return the details of a station as labels and texts: resources, source, origin, exercise label."""
    own = [each for each in station_file.resources if each.station == station.id]
    source = station_file.source_of.get(station.source)
    lines = [
        ("Kind", station.kind),
        ("Agency", station.agency),
        ("Address", station.address),
        ("Staffing", station.staffing),
        ("Resources", count_types(own, _TYPES) or "unknown"),
        ("Source", "" if source is None else f"{source.name}, {source.licence}, {source.retrieved}"),
        ("Origin", station.origin),
    ]
    if is_exercise(station, own):
        lines.append(("", EXERCISE))
    return [(label, text) for label, text in lines if text]


def is_exercise(station: Station, own: Sequence[Resource]) -> bool:
    """Return True if a station or any of its resources was invented."""
    return station.origin == "exercise" or any(each.origin == "exercise" for each in own)


def _has_resource_condition(query: Query) -> bool:
    """Return True if a query has a condition on resources."""
    return replace(query, near=None, within_km=None) != Query()


def _shortest_times(matches: Sequence[search.Match]) -> dict[int, float]:
    """Return the shortest time of each station, min, by its number."""
    least: dict[int, float] = {}
    for each in matches:
        if each.minutes is not None:
            number = each.station.id
            least[number] = min(each.minutes, least.get(number, each.minutes))
    return least


def _exercise_stations(station_file: StationFile) -> set[int]:
    """Return the numbers of stations with a resource of an exercise."""
    return {each.station for each in station_file.resources if each.origin == "exercise"}


def _exercise(station: Station, own: set[int]) -> bool:
    return station.origin == "exercise" or station.id in own
