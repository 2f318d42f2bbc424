"""Reader of station files, including files edited in QGIS."""

from __future__ import annotations

import contextlib
import math
import sqlite3
from dataclasses import fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from ..errors import input_error
from ..run.observations import geopackage
from . import geometry
from .records import MODES, ORIGINS, STATUSES, Area, Availability, Resource, Source, Station, Type
from .station_file import StationFile

Record = TypeVar("Record", Source, Type, Resource)

_NOT_STATIONS = "is not a station file; make one: firetwin stations import FILE --out STATIONS.gpkg"


def read(path: Path) -> StationFile:
    """Read all tables; the geometry of a station is its position.

    Raises
    ------
    InputError
        The file is missing, is not a station file, or a row is damaged.
    """
    if not path.is_file():
        raise input_error(path, "there is no such file; check the path")
    try:
        with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as base:
            tables = {name for (name,) in base.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
            if not {"source", "type", "station", "resource", "availability", "area"} <= tables:
                raise input_error(path, _NOT_STATIONS)
            return _Reader(path, base).station_file()
    except UnicodeDecodeError:
        raise input_error(path, "cannot be read: a text in it is not UTF-8") from None
    except sqlite3.DatabaseError as error:
        reason = _NOT_STATIONS if "not a database" in str(error) else f"cannot be read: {error}"
        raise input_error(path, reason) from None


def _text(value: Any) -> str:
    """Convert a value to text, as SQLite allows any type in a column."""
    if isinstance(value, str):
        return value
    return "" if value is None else str(value)


class _Reader:
    def __init__(self, path: Path, base: sqlite3.Connection) -> None:
        self.path, self.base = path, base

    def station_file(self) -> StationFile:
        station_file = StationFile(
            self.stations(),
            self.records(Resource, "resource", "id"),
            self.availability(),
            self.records(Source, "source", "id"),
            self.records(Type, "type", "fid"),
            self.areas(),
        )
        self.check(station_file)
        return station_file

    def records(self, kind: type[Record], table: str, key: str) -> tuple[Record, ...]:
        """Read records whose fields have the names of the columns; a missing text is empty."""
        names = [each.name for each in fields(kind)]
        texts = [k for k, each in enumerate(fields(kind)) if each.type == "str"]
        flags = [k for k, each in enumerate(fields(kind)) if each.type == "bool"]
        found = []
        for row in self.base.execute(f"SELECT {', '.join(names)} FROM {table} ORDER BY {key}"):
            values = list(row)
            for k in texts:
                values[k] = _text(values[k])
            for k in flags:
                values[k] = bool(values[k])
            found.append(kind(*values))
        return tuple(found)

    def stations(self) -> tuple[Station, ...]:
        command = (
            "SELECT fid, geom, name, origin, source, kind, agency, address, source_id, picture "
            "FROM station ORDER BY fid"
        )
        found = []
        for number, blob, name, origin, source, *texts in self.base.execute(command):
            latitude, longitude = self.position(number, blob)
            found.append(
                Station(number, _text(name), latitude, longitude, origin, source, *map(_text, texts))
            )
        return tuple(found)

    def position(self, number: int, blob: Any) -> tuple[float, float]:
        found = geometry.position(blob) if isinstance(blob, bytes) else None
        if found is None and isinstance(blob, bytes):
            points = geopackage.points(blob)
            found = (float(points[0][1]), float(points[0][0])) if points else None
        if found is None or not (abs(found[0]) <= 90.0 and abs(found[1]) <= 540.0):
            self.fail("station", number, "has no position in degrees; move it in a map, or remove it")
        return found

    def availability(self) -> tuple[Availability, ...]:
        command = "SELECT id, resource, begins, ends, status, area FROM availability ORDER BY id"
        return tuple(
            Availability(
                resource,
                self.time(number, "begins", begins),
                self.time(number, "ends", ends),
                status,
                _text(area),
            )
            for number, resource, begins, ends, status, area in self.base.execute(command)
        )

    def time(self, number: int, column: str, text: Any) -> datetime:
        try:
            when = datetime.fromisoformat(text)
        except (TypeError, ValueError):
            self.fail("availability", number, f"has no time in {column}; write 2014-09-17T22:42:00Z")
        return when.astimezone(UTC) if when.tzinfo else when.replace(tzinfo=UTC)

    def areas(self) -> tuple[Area, ...]:
        found = []
        command = "SELECT fid, geom, name, kind, station FROM area ORDER BY fid"
        for number, blob, name, kind, station in self.base.execute(command):
            polygons = geopackage.polygons(blob) if isinstance(blob, bytes) else ()
            if not polygons:
                self.fail("area", number, "has no polygon; draw it again, or remove it")
            found.append(Area(number, _text(name), _text(kind), station, polygons))
        return tuple(found)

    def check(self, station_file: StationFile) -> None:
        """Check references, words and numbers that other programs may have written."""
        stations, sources = station_file.station_row, station_file.source_of
        resources = {each.id for each in station_file.resources}
        for station in station_file.stations:
            self.origin("station", station.id, station.origin, station.source in sources)
        for each in station_file.resources:
            self.origin("resource", each.id, each.origin, each.source in sources)
            if each.station not in stations:
                self.fail("resource", each.id, f"names station {each.station}, which does not exist")
            if each.type not in station_file.type_of:
                self.fail("resource", each.id, f'has type "{each.type}", which is not in table type')
            if each.mode not in MODES:
                self.fail("resource", each.id, f'has mode "{each.mode}"; use one of {", ".join(MODES)}')
            self.numbers(each)
        for window in station_file.availability:
            if window.resource not in resources:
                self.fail("resource", window.resource, "has a window of availability but does not exist")
            if window.status not in STATUSES:
                reason = f'has status "{window.status}"; use one of {", ".join(STATUSES)}'
                self.fail("resource", window.resource, reason)
        for area in station_file.areas:
            if area.station not in stations:
                self.fail("area", area.id, f"names station {area.station}, which does not exist")

    def origin(self, table: str, number: int, origin: str, known: bool) -> None:
        if origin not in ORIGINS:
            self.fail(table, number, f'has origin "{origin}"; use one of {", ".join(ORIGINS)}')
        if not known:
            self.fail(table, number, "has no source; enter an id of table source")

    def numbers(self, each: Resource) -> None:
        """Check that numbers are finite and not negative, the speed above 0, and the count at least 1."""
        for name in NUMBERS:
            value = getattr(each, name)
            if value is None:
                continue
            if not isinstance(value, int | float) or not 0.0 <= value < math.inf:
                self.fail("resource", each.id, f"has {name} {value!r}; enter a number of at least 0")
        if each.speed_km_h == 0.0:
            self.fail("resource", each.id, "has speed_km_h 0; leave it empty if it is unknown")
        if not isinstance(each.count, int) or each.count < 1:
            self.fail("resource", each.id, f"has count {each.count!r}; enter a whole number of at least 1")

    def fail(self, table: str, number: int, reason: str) -> NoReturn:
        raise input_error(self.path, f"{table} {number} {reason}")


NUMBERS = (
    "load_kg",
    "speed_km_h",
    "mobilise_min",
    "radius_km",
    "line_m_h",
    "cost_mobilise",
    "cost_hour",
    "cost_day",
)
"""Numeric fields of a resource; each may be unknown."""
