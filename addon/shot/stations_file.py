"""Stations and resources of a GeoPackage, as far as signs show them."""

from __future__ import annotations

import contextlib
import sqlite3
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import input_error
from ..run.observations import geopackage

ORIGINS = ("fact", "exercise", "user")
"""A published fact; invented for an exercise; given by the user."""

_LONGEST = 80  # characters of a name
_QUERY = "SELECT station, type, count, speed_km_h, mobilise_min, origin FROM resource ORDER BY station, id"
_NEEDS = "a table of features station with name, kind and origin, and a table resource"


@dataclass(frozen=True, slots=True)
class Station:
    """A station, degrees north and east; `origin` is one of `ORIGINS`."""

    id: int
    name: str
    latitude: float
    longitude: float
    origin: str
    kind: str


@dataclass(frozen=True, slots=True)
class Resource:
    """What stands at a station: `type` such as ``engine/3``, km/h, and minutes to the departure."""

    station: int
    type: str
    count: int
    speed_km_h: float | None
    mobilise_min: float | None
    origin: str


def read(path: Path) -> tuple[list[Station], list[Resource]]:
    """Read a file of stations.

    Raises
    ------
    InputError
        It is missing, is another file, or a row is damaged.
    """
    if not path.is_file():
        raise input_error(path, 0, 0, "there is no such file; check the path")
    features = [each for each in geopackage.read(path) if each.properties["layer"] == "station"]
    try:
        with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as base:
            resources = [Resource(*row) for row in base.execute(_QUERY)]
    except sqlite3.Error as error:
        raise input_error(path, 0, 0, f"has no stations: it needs {_NEEDS} ({error})") from None
    stations = [_station(path, each.place, each.properties, each.points) for each in features]
    for number, resource in enumerate(resources, 1):
        _check(path, f"row {number} of resource", resource)
    return stations, resources


def _station(path: Path, place: str, properties: Any, points: Any) -> Station:
    if len(points) != 1:
        raise input_error(path, 0, 0, f"{place} has {len(points)} points; a station is one point")
    try:
        name, origin = " ".join(str(properties["name"]).split()), str(properties["origin"])
        number, kind = int(properties["fid"]), " ".join(str(properties["kind"] or "").split())
    except (KeyError, TypeError, ValueError) as error:
        raise input_error(path, 0, 0, f"{place} lacks or has no good {error}; it needs {_NEEDS}") from None
    if not 0 < len(name) <= _LONGEST:
        raise input_error(path, 0, 0, f"{place}: a name has 1 to {_LONGEST} letters, not {len(name)}")
    if origin not in ORIGINS:
        raise input_error(path, 0, 0, f'{place}: origin is "{origin}"; it is {", ".join(ORIGINS)}')
    longitude, latitude = map(float, points[0])
    return Station(number, name, latitude, longitude, origin, kind[:_LONGEST])


def _check(path: Path, place: str, resource: Resource) -> None:
    """Check a row that SQLite may hold with any type."""
    good = isinstance(resource.type, str) and isinstance(resource.count, int) and resource.origin in ORIGINS
    numbers = (resource.speed_km_h, resource.mobilise_min)
    good = good and all(each is None or isinstance(each, int | float) for each in numbers)
    if not good or (resource.speed_km_h is not None and resource.speed_km_h <= 0):
        raise input_error(path, 0, 0, f"{place} has a value of another type, or a speed that is not above 0")
