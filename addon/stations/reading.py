"""Reader of station files, including files edited in QGIS."""

from __future__ import annotations

import sqlite3
from dataclasses import fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from .. import foreign_database, limits
from ..errors import input_error, reading
from ..foreign_database import ForeignDatabase
from ..geopackage import position
from ..limits import YEARS
from ..run.observations import geopackage
from .records import MODES, ORIGINS, STATUSES, Area, Availability, Resource, Source, Station, Type
from .station_file import StationFile

_STATION = ("fid", "geom", "name", "origin", "source", "kind", "agency", "address", "source_id", "picture")
_STAFFING = "staffing"  # a column that files of older versions do not have
_AVAILABILITY = ("id", "resource", "begins", "ends", "status", "area")
_TYPE_NUMBERS = ("tank_l", "payload_kg", "pump_l_min", "people")
_AREA = ("fid", "geom", "name", "kind", "station")
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
    with reading(path):
        try:
            with foreign_database.opened(path) as base:
                if not {"source", "type", "station", "resource", "availability", "area"} <= base.tables():
                    raise input_error(path, _NOT_STATIONS)
                return _Reader(path, base).station_file()
        except sqlite3.DatabaseError as error:
            if "not a database" in str(error):
                raise input_error(path, _NOT_STATIONS) from None
            raise


def _text(value: Any) -> str:
    """Convert a value to text, as SQLite allows any type in a column."""
    if isinstance(value, str):
        return value
    return "" if value is None else str(value)


class _Reader:
    def __init__(self, path: Path, base: ForeignDatabase) -> None:
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
        records = []
        for row in self.base.rows(table, names, key):
            values = list(row)
            for k in texts:
                values[k] = _text(values[k])
            for k in flags:
                values[k] = bool(values[k])
            records.append(kind(*values))
        return tuple(records)

    def stations(self) -> tuple[Station, ...]:
        stations = []
        more = (_STAFFING,) if _STAFFING in self.base.columns("station") else ()
        for number, blob, name, origin, source, *texts in self.base.rows("station", _STATION + more, "fid"):
            latitude, longitude = self.position(number, blob)
            stations.append(
                Station(number, _text(name), latitude, longitude, origin, source, *map(_text, texts))
            )
        return tuple(stations)

    def position(self, number: int, blob: Any) -> tuple[float, float]:
        coordinates = position(blob) if isinstance(blob, bytes) else None
        if coordinates is None and isinstance(blob, bytes):
            points = geopackage.points(blob)
            coordinates = (float(points[0][1]), float(points[0][0])) if points else None
        if coordinates is None or not (abs(coordinates[0]) <= 90.0 and abs(coordinates[1]) <= 540.0):
            self.fail("station", number, "has no position in degrees; move it in a map, or remove it")
        return coordinates

    def availability(self) -> tuple[Availability, ...]:
        rows = self.base.rows("availability", _AVAILABILITY, "id")
        return tuple(
            Availability(
                resource,
                self.time(number, "begins", begins),
                self.time(number, "ends", ends),
                status,
                _text(area),
            )
            for number, resource, begins, ends, status, area in rows
        )

    def time(self, number: int, column: str, text: Any) -> datetime:
        try:
            when = datetime.fromisoformat(text)
        except (TypeError, ValueError):
            self.fail("availability", number, f"has no time in {column}; write 2014-09-17T22:42:00Z")
        if not YEARS[0] <= when.year <= YEARS[1]:
            reason = f"has the year {when.year} in {column}; enter a year from {YEARS[0]} to {YEARS[1]}"
            self.fail("availability", number, reason)
        return when.astimezone(UTC) if when.tzinfo else when.replace(tzinfo=UTC)

    def areas(self) -> tuple[Area, ...]:
        areas = []
        for number, blob, name, kind, station in self.base.rows("area", _AREA, "fid"):
            polygons = geopackage.polygons(blob) if isinstance(blob, bytes) else ()
            if not polygons:
                self.fail("area", number, "has no polygon; draw it again, or remove it")
            areas.append(Area(number, _text(name), _text(kind), station, polygons))
        return tuple(areas)

    def check(self, station_file: StationFile) -> None:
        """Check references, words and numbers that other programs may have written."""
        stations, sources = station_file.station_row, station_file.source_of
        resources = {each.id for each in station_file.resources}
        for kind in station_file.types:
            for name in _TYPE_NUMBERS:
                self.number("type", kind.code, name, getattr(kind, name))
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
        """Check that numbers are not negative or huge, the speed is above 0, and the count at least 1."""
        for name in NUMBERS:
            self.number("resource", each.id, name, getattr(each, name))
        if each.speed_km_h == 0.0:
            self.fail("resource", each.id, "has speed_km_h 0; leave it empty if it is unknown")
        if not isinstance(each.count, int) or each.count < 1:
            self.fail("resource", each.id, f"has count {each.count!r}; enter a whole number of at least 1")

    def number(self, table: str, row: int | str, name: str, value: Any) -> None:
        if value is None or (isinstance(value, int | float) and limits.is_quantity(value)):
            return
        least = f"enter 0, or {limits.SMALLEST_NUMBER:.6f} to {limits.LARGEST_NUMBER:,.0f}"
        self.fail(table, row, f"has {name} {value!r:.40}; {least}")

    def fail(self, table: str, number: int | str, reason: str) -> NoReturn:
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
