"""GeoPackage writer (OGC 12-128, version 1.4): feature tables with dates, and their QGIS styles."""

from __future__ import annotations

import contextlib
import sqlite3
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..stations import schema
from ..stations.writing import datetime_text

Array = NDArray[np.float64]

WGS84, WGS84_3D = schema.WGS84, 4979
_NAME_3D = "WGS 84 with heights above the ellipsoid"
_HEADER = struct.Struct("<2sBBi")
_SHAPE = struct.Struct("<BII")
_LITTLE, _EMPTY, _BOX_XY = 0x01, 0x10, 0x02  # flags: byte order; no points; an envelope of x and y
_CODES = {"POINT": 1, "LINESTRING": 2, "POLYGON": 3, "MULTILINESTRING": 5, "MULTIPOLYGON": 6}
_STYLES = """\
CREATE TABLE layer_styles (
  id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, f_table_catalog TEXT(256), f_table_schema TEXT(256),
  f_table_name TEXT(256), f_geometry_column TEXT(256), styleName TEXT(30), styleQML TEXT, styleSLD TEXT,
  useAsDefault BOOLEAN, description TEXT, owner TEXT(30), ui TEXT(30), update_time DATETIME)"""


@dataclass(frozen=True)
class Table:
    """A feature table.

    Attributes
    ----------
    geometry
        POINT, LINESTRING, MULTILINESTRING or MULTIPOLYGON.
    columns
        SQL type of each column.
    rows
        Geometry and values of each feature. A geometry is (n, k) coordinates for points and lines, a list of
        them for MULTILINESTRING, and a list of polygons (lists of rings) for MULTIPOLYGON: degrees east and
        north, height, m, and the measure of lines.
    """

    name: str
    title: str
    geometry: str
    columns: dict[str, str]
    rows: list[tuple[Any, Sequence[Any]]] = field(default_factory=list)
    z: bool = False
    m: bool = False

    @property
    def srs(self) -> int:
        """EPSG code of the coordinates."""
        return WGS84_3D if self.z else WGS84

    def bounds(self) -> list[float | None]:
        """Compute west, south, east and north of all features; None without any."""
        flat = [points[:, :2] for shape, _ in self.rows for points in _points(shape)]
        return [*_box(np.concatenate(flat))] if flat else [None] * 4


def write(path: Path, tables: Sequence[Table], styles: dict[str, str], when: datetime) -> None:
    """Write a GeoPackage.

    Parameters
    ----------
    styles
        QML of tables by name, which QGIS applies when it opens them.
    when
        Time of change in the file.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """

    def put(part: Path) -> None:
        with contextlib.closing(sqlite3.connect(part, isolation_level=None)) as base:
            base.executescript("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; BEGIN;")
            base.execute(f"PRAGMA application_id = {schema.APPLICATION_ID}")
            base.execute(f"PRAGMA user_version = {schema.USER_VERSION}")
            for command in schema.STANDARD.split(";\n"):
                base.execute(command)
            _fill(base, tables, styles, datetime_text(when))
            base.execute("COMMIT")

    files.write(path, put)


def blob(table: Table, shape: Any) -> bytes:
    """Encode the geometry of a row."""
    parts = _points(shape)
    if not parts:
        return _HEADER.pack(b"GP", 0, _LITTLE | _EMPTY, table.srs) + _geometry(table, shape)
    west, south, east, north = _box(np.concatenate([points[:, :2] for points in parts]))
    envelope = struct.pack("<4d", west, east, south, north)
    return _HEADER.pack(b"GP", 0, _LITTLE | _BOX_XY, table.srs) + envelope + _geometry(table, shape)


def _geometry(table: Table, shape: Any) -> bytes:
    """Encode as ISO well-known binary."""
    more = 1000 * table.z + 2000 * table.m

    def line(points: Array, kind: str) -> bytes:
        code = struct.pack("<BI", 1, _CODES[kind] + more)
        count = b"" if kind == "POINT" else struct.pack("<I", len(points))
        return code + count + points.astype("<f8").tobytes()

    if table.geometry in ("POINT", "LINESTRING"):
        return line(shape, table.geometry)
    found = [_SHAPE.pack(1, _CODES[table.geometry] + more, len(shape))]
    for part in shape:
        if table.geometry == "MULTILINESTRING":
            found.append(line(part, "LINESTRING"))
        else:
            found.append(_SHAPE.pack(1, _CODES["POLYGON"] + more, len(part)))
            found += [struct.pack("<I", len(ring)) + ring.astype("<f8").tobytes() for ring in part]
    return b"".join(found)


def _points(shape: Any) -> list[Array]:
    """List the arrays of coordinates of a geometry."""
    if isinstance(shape, np.ndarray):
        return [shape]
    return [points for part in shape for points in _points(part)]


def _box(points: Array) -> list[float]:
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()]


def _fill(base: sqlite3.Connection, tables: Sequence[Table], styles: dict[str, str], changed: str) -> None:
    systems = (*schema.SYSTEMS, (_NAME_3D, WGS84_3D, "EPSG", WGS84_3D, schema.WKT_3D, _NAME_3D))
    _many(base, "gpkg_spatial_ref_sys", systems)
    for table in tables:
        columns = "".join(f", {name} {kind}" for name, kind in table.columns.items())
        base.execute(
            f"CREATE TABLE {table.name} (fid INTEGER PRIMARY KEY NOT NULL, geom {table.geometry}{columns})"
        )
        content = (table.name, "features", table.name, table.title, changed, *table.bounds(), table.srs)
        _many(base, "gpkg_contents", [content])
        shape = (table.name, "geom", table.geometry, table.srs, int(table.z), int(table.m))
        _many(base, "gpkg_geometry_columns", [shape])
        rows = [
            (number, blob(table, geometry), *values)
            for number, (geometry, values) in enumerate(table.rows, 1)
        ]
        _many(base, table.name, rows)
    if styles:
        base.execute(_STYLES)
        nowhere = [None] * 5
        content = ("layer_styles", "attributes", "layer_styles", "QGIS styles", changed, *nowhere)
        _many(base, "gpkg_contents", [content])
        listed = [
            (number, "", "", name, "geom", name, qml, "", 1, "", "", None, changed)
            for number, (name, qml) in enumerate(styles.items(), 1)
        ]
        _many(base, "layer_styles", listed)


def _many(base: sqlite3.Connection, table: str, rows: Iterable[Sequence[Any]]) -> None:
    listed = list(rows)
    if listed:
        marks = ", ".join("?" * len(listed[0]))
        base.executemany(f"INSERT INTO {table} VALUES ({marks})", listed)
