"""Writer of station files."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Iterable
from dataclasses import astuple, fields
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from .. import files
from ..errors import input_error
from ..run import times
from . import geometry, schema
from .records import Resource, Source, Type
from .station_file import StationFile


def write(station_file: StationFile, path: Path) -> None:
    """Write a station file; an existing file is replaced when the new one is complete.

    Raises
    ------
    InputError
        The file cannot be written, or a row breaks a rule of the tables.
    """

    def put(part: Path) -> None:
        with contextlib.closing(sqlite3.connect(part, isolation_level=None)) as base:
            base.executescript("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; BEGIN;")
            _fill(base, station_file)
            base.execute("COMMIT")

    try:
        files.write(path, put)
    except sqlite3.IntegrityError as error:
        raise input_error(path, f"cannot store these stations: {error}") from error


def _fill(base: sqlite3.Connection, station_file: StationFile) -> None:
    base.execute(f"PRAGMA application_id = {schema.APPLICATION_ID}")
    base.execute(f"PRAGMA user_version = {schema.USER_VERSION}")
    for command in schema.TABLES.split(";\n"):
        base.execute(command)
    _many(base, "gpkg_spatial_ref_sys", schema.SYSTEMS)
    _contents(base, station_file)
    base.execute("PRAGMA foreign_keys = ON")
    _rows(base, station_file)
    _many(base, "gpkg_extensions", [schema.EXTENSION])
    for trigger in schema.TRIGGERS.strip().split("\n"):
        base.execute(trigger)


def _contents(base: sqlite3.Connection, station_file: StationFile) -> None:
    """Write gpkg_contents and gpkg_geometry_columns; the newest source gives the date of change."""
    newest = max((each.retrieved for each in station_file.sources), default="") or "1970-01-01"
    change = f"{newest[:10]}T00:00:00.000Z"
    latitude, longitude = station_file.positions
    corners = [ring for area in station_file.areas for rings in area.polygons for ring in rings]
    points = {
        "station": np.column_stack([longitude, latitude]),
        "area": np.concatenate(corners) if corners else np.empty((0, 2)),
    }
    for name, kind in schema.FEATURES.items():
        found = points[name]
        box = [*found.min(axis=0), *found.max(axis=0)] if len(found) else [None] * 4
        _many(base, "gpkg_contents", [(name, "features", name, "", change, *box, schema.WGS84)])
        _many(base, "gpkg_geometry_columns", [(name, "geom", kind, schema.WGS84, 0, 0)])
    nowhere = [None] * 5
    rows = [(name, "attributes", name, "", change, *nowhere) for name in schema.ATTRIBUTES]
    _many(base, "gpkg_contents", rows)


def _rows(base: sqlite3.Connection, station_file: StationFile) -> None:
    """Write Firetwin's tables; the ids of the records number the rows."""
    _records(base, "source", Source, station_file.sources)
    types = ((number, *astuple(each)) for number, each in enumerate(station_file.types, 1))
    _many(base, "type", types, "fid", *(each.name for each in fields(Type)))
    stations = (
        (s.id, geometry.point(s.latitude, s.longitude), s.name, s.kind, s.agency, s.address, s.source,
         s.source_id, s.origin, s.picture, s.staffing)
        for s in station_file.stations
    )  # fmt: skip
    _many(base, "station", stations)
    boxes = ((s.id, s.longitude, s.longitude, s.latitude, s.latitude) for s in station_file.stations)
    _many(base, schema.INDEX, boxes)
    _records(base, "resource", Resource, station_file.resources)
    windows = (
        (number, each.resource, datetime_text(each.begins), datetime_text(each.ends), each.status, each.area)
        for number, each in enumerate(station_file.availability, 1)
    )
    _many(base, "availability", windows)
    areas = ((a.id, geometry.multipolygon(a.polygons), a.name, a.kind, a.station) for a in station_file.areas)
    _many(base, "area", areas)


def datetime_text(when: datetime) -> str:
    """Format a time as in a GeoPackage, to a millisecond: ``2014-09-17T22:42:00.000Z``."""
    return times.iso(when, "milliseconds")


def _records(base: sqlite3.Connection, table: str, kind: type, rows: Iterable[Any]) -> None:
    """Write records whose fields have the names of the columns."""
    names = [each.name for each in fields(kind)]
    _many(base, table, (tuple(getattr(row, name) for name in names) for row in rows), *names)


def _many(base: sqlite3.Connection, table: str, rows: Iterable[tuple[Any, ...]], *names: str) -> None:
    listed = list(rows)
    if listed:
        columns = f" ({', '.join(names)})" if names else ""
        marks = ", ".join("?" * len(listed[0]))
        base.executemany(f"INSERT INTO {table}{columns} VALUES ({marks})", listed)
