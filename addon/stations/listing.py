"""Stations for a list: those whose resources answer a query, each once, and what is known of one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from . import search, station_search
from .describe import count_types
from .query import Query
from .records import EXERCISE, Resource, Station
from .station_file import StationFile

_TYPES = 6  # types of resources that are named of one station


@dataclass(frozen=True)
class Row:
    """A station of a list; None is not known.

    Attributes
    ----------
    distance_km
        Straight distance to the query's place, km.
    minutes
        Least minutes from the order to the arrival of what answers the query.
    exercise
        Whether the station or any of its resources was invented for an exercise.
    """

    station: Station
    distance_km: float | None
    minutes: float | None
    exercise: bool


@dataclass(frozen=True)
class Listing:
    """Rows by minutes, or else by distance; and how many each reason left out."""

    rows: list[Row]
    left_out: dict[str, int] = field(default_factory=dict)


def key(station: Station) -> str:
    """What names a station for good: its number in the file, and its name."""
    return f"{station.id} {station.name}"


def find(listed: Sequence[Station], wanted: str) -> Station | None:
    """The station of a key; where no number and name are these, the only one of the name."""
    same = [each for each in listed if key(each) == wanted]
    same = same or [each for each in listed if each.name == wanted.partition(" ")[2]]
    return same[0] if len(same) == 1 else None


def survey(station_file: StationFile, query: Query) -> Listing:
    """Stations whose resources answer a query; of one without conditions on resources all stations."""
    own = _own(station_file)
    if not _asks(query) or not station_file.resources:
        least = _least(search.find(station_file, query)) if station_file.resources else {}
        found = station_search.survey(station_file, query)
        rows = [
            Row(each.station, each.distance_km, least.get(each.station.id), _exercise(each.station, own))
            for each in found.matches
        ]
        return Listing(rows, found.left_out)
    answer = search.survey(station_file, query)
    least = _least(answer.matches)
    first = {each.station.id: each for each in reversed(answer.matches)}
    order = {each.station.id: None for each in answer.matches}
    rows = [
        Row(first[n].station, first[n].distance_km, least.get(n), _exercise(first[n].station, own))
        for n in order
    ]
    return Listing(rows, answer.left_out)


def facts(station_file: StationFile, station: Station) -> list[tuple[str, str]]:
    """Label and text of what is known of a station: resources, source, origin and the mark of an exercise."""
    own = [each for each in station_file.resources if each.station == station.id]
    source = station_file.source_of.get(station.source)
    lines = [
        ("Kind", station.kind),
        ("Agency", station.agency),
        ("Address", station.address),
        ("Resources", count_types(own, _TYPES) or "none known"),
        ("Source", "" if source is None else f"{source.name}, {source.licence}, {source.retrieved}"),
        ("Origin", station.origin),
    ]
    if exercise(station, own):
        lines.append(("", EXERCISE))
    return [(label, text) for label, text in lines if text]


def exercise(station: Station, own: Sequence[Resource]) -> bool:
    """Whether a station or any of its own resources was invented."""
    return station.origin == "exercise" or any(each.origin == "exercise" for each in own)


def _asks(query: Query) -> bool:
    """Whether a query has a condition on resources."""
    return replace(query, near=None, within_km=None) != Query()


def _least(matches: Sequence[search.Match]) -> dict[int, float]:
    """Least minutes of each station, by its number."""
    least: dict[int, float] = {}
    for each in matches:
        if each.minutes is not None:
            number = each.station.id
            least[number] = min(each.minutes, least.get(number, each.minutes))
    return least


def _own(station_file: StationFile) -> set[int]:
    """Numbers of stations that have a resource of an exercise."""
    return {each.station for each in station_file.resources if each.origin == "exercise"}


def _exercise(station: Station, own: set[int]) -> bool:
    return station.origin == "exercise" or station.id in own
