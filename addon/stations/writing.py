"""Writer of station files."""

from __future__ import annotations

import functools
import sqlite3
from collections.abc import Iterable
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import geopackage, output
from ..errors import input_error
from ..geopackage import insert
from ..run import times
from ..run.observations.feature import Polygon
from . import schema
from .records import Resource, Source, Type
from .station_file import StationFile


def write(station_file: StationFile, path: Path, overwrite: bool = False) -> None:
    """Write a station file; an earlier one is replaced when the new one is complete.

    Parameters
    ----------
    overwrite
        Replace a file of others (see `output`).

    Raises
    ------
    InputError
        The file cannot be written, or a row breaks a rule of the tables.
    """
    try:
        put = functools.partial(output.write, overwrite=overwrite)
        geopackage.write(path, lambda base: _fill(base, station_file), put)
    except sqlite3.IntegrityError as error:
        raise input_error(path, f"cannot store these stations: {error}") from error


def _fill(base: sqlite3.Connection, station_file: StationFile) -> None:
    geopackage.create_tables(base, schema.TABLES)
    insert(base, "gpkg_spatial_ref_sys", geopackage.SYSTEMS)
    _contents(base, station_file)
    base.execute("PRAGMA foreign_keys = ON")
    _rows(base, station_file)
    insert(base, "gpkg_extensions", [schema.EXTENSION])
    for trigger in schema.TRIGGERS.strip().split("\n"):
        base.execute(trigger)


def _contents(base: sqlite3.Connection, station_file: StationFile) -> None:
    """List the tables; the newest source gives the date of change."""
    newest = max((each.retrieved for each in station_file.sources), default="") or "1970-01-01"
    changed = f"{newest[:10]}T00:00:00.000Z"
    latitude, longitude = station_file.positions
    corners = [ring for area in station_file.areas for rings in area.polygons for ring in rings]
    points = {
        "station": np.column_stack([longitude, latitude]),
        "area": np.concatenate(corners) if corners else np.empty((0, 2)),
    }
    for name, kind in schema.FEATURES.items():
        geopackage.add_features(base, name, "", changed, kind, points[name])
    for name in schema.ATTRIBUTES:
        geopackage.add_attributes(base, name, "", changed)


def _rows(base: sqlite3.Connection, station_file: StationFile) -> None:
    """Write Firetwin's tables; the ids of the records number the rows."""
    _records(base, "source", Source, station_file.sources)
    types = ((number, *astuple(each)) for number, each in enumerate(station_file.types, 1))
    insert(base, "type", types, "fid", *(each.name for each in fields(Type)))
    stations = (
        (s.id, geopackage.point(s.latitude, s.longitude), s.name, s.kind, s.agency, s.address, s.source,
         s.source_id, s.origin, s.picture, s.staffing)
        for s in station_file.stations
    )  # fmt: skip
    insert(base, "station", stations)
    boxes = ((s.id, s.longitude, s.longitude, s.latitude, s.latitude) for s in station_file.stations)
    insert(base, schema.INDEX, boxes)
    _records(base, "resource", Resource, station_file.resources)
    windows = (
        (number, each.resource, _time(each.begins), _time(each.ends), each.status, each.area)
        for number, each in enumerate(station_file.availability, 1)
    )
    insert(base, "availability", windows)
    areas = (
        (a.id, geopackage.encode("MULTIPOLYGON", _closed(a.polygons)), a.name, a.kind, a.station)
        for a in station_file.areas
    )
    insert(base, "area", areas)


_time = functools.partial(times.iso, timespec="milliseconds")


def _closed(polygons: Iterable[Polygon]) -> list[list[NDArray[np.float64]]]:
    return [[np.concatenate([ring, ring[:1]]) for ring in rings] for rings in polygons]


def _records(base: sqlite3.Connection, table: str, kind: type, rows: Iterable[Any]) -> None:
    """Write records whose fields have the names of the columns."""
    names = [each.name for each in fields(kind)]
    insert(base, table, (tuple(getattr(row, name) for name in names) for row in rows), *names)
