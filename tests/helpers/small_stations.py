"""Station files with a few invented rows, written by the program, for tests."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from pathlib import Path

from firetwin.stations import types, writing
from firetwin.stations.records import Availability, Resource, Source, Station
from firetwin.stations.station_file import StationFile

SOURCE = Source(1, "Made up for tests", "CC0-1.0", "2026-01-01", "https://example.org/a")
DAYS = datetime(2014, 9, 17, tzinfo=UTC), datetime(2014, 9, 19, tzinfo=UTC)
KINDS = ("fire station", "air base", "lookout")


def resource(number, station, type_, count=1, speed=None, minutes=None, origin="exercise", name="", **more):
    """A resource with its km/h and minutes to the departure."""
    known = {"count": count, "speed_km_h": speed, "mobilise_min": minutes} | more
    return Resource(number, station, type_, name, origin, SOURCE.id, **known)


def put(
    path: Path,
    stations: Iterable[Station],
    resources: Sequence[Resource] = (),
    windows: Iterable[Availability] = (),
) -> Path:
    """Write records, with the types that the resources name."""
    known = {each.code: each for each in types.standard_types()}
    known |= {each.type: types.user_type(each.type) for each in resources if each.type not in known}
    writing.write(
        StationFile(tuple(stations), tuple(resources), tuple(windows), (SOURCE,), tuple(known.values())), path
    )
    return path


def write(path, stations, resources=()):
    """Write stations (number, name, latitude, longitude, kind, origin), and resources.

    A resource is station, type, count, km/h, minutes, origin.
    """
    rows = [Station(*row[:4], row[5], SOURCE.id, kind=row[4]) for row in stations]
    return put(path, rows, [resource(k, *row) for k, row in enumerate(resources, 1)])


def briefed(path: Path, places: Sequence[tuple[str, float, float]], origin: str = "exercise") -> Path:
    """Write stations (name, latitude, longitude), every second with an engine and a crew of an exercise."""
    rows = [
        Station(
            k, name, latitude, longitude, origin, SOURCE.id, KINDS[k % 3], "Exercise agency",
            f"{k} Example Road",
        )
        for k, (name, latitude, longitude) in enumerate(places, 1)
    ]  # fmt: skip
    resources = [
        resource(
            10 * row.id + k, row.id, type_, 2, 60.0, 5.0, name=f"{name}-{row.id}",
            cost_hour=210.0, currency="USD", night=True, note="made up",
        )
        for row in rows[::2]
        for k, (type_, name) in enumerate((("engine/3", "E-31"), ("crew/IHC", "C-2")))
    ]  # fmt: skip
    return put(path, rows, resources, [Availability(each.id, *DAYS, area="Local") for each in resources])
