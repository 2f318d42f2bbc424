"""GeoPackage writer (OGC 12-128, version 1.4): standard tables, their rows, and geometry on WGS84.

A geometry is (n, k) coordinates for points and lines, a list of them for MULTILINESTRING, and a list of
polygons (lists of closed rings) for MULTIPOLYGON: degrees east and north, height (m), measure of lines.
"""

from __future__ import annotations

import contextlib
import sqlite3
import struct
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import files

Array = NDArray[np.float64]

WGS84, WGS84_3D = 4326, 4979
"""EPSG codes of degrees, and of degrees with heights above the ellipsoid."""
_APPLICATION_ID = 0x47504B47  # "GPKG"
_USER_VERSION = 10400
_CODES = {"POINT": 1, "LINESTRING": 2, "POLYGON": 3, "MULTILINESTRING": 5, "MULTIPOLYGON": 6}
_POINT = struct.Struct("<2sBBiBIdd")  # without an envelope
_HEADER, _SHAPE = struct.Struct("<2sBBi"), struct.Struct("<BII")
_LITTLE, _EMPTY, _BOX_XY = 0x01, 0x10, 0x02  # flags: byte order; no points; an envelope of x and y

_TABLES = """
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
  description TEXT DEFAULT '', last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_extensions (
  table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL, definition TEXT NOT NULL,
  scope TEXT NOT NULL,
  CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name));
"""
_WKT = (
    'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],'
    'AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],'
    'UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]]'
)
_WKT_3D = (
    'GEOGCS["WGS 84",DATUM["World Geodetic System 1984",SPHEROID["WGS 84",6378137,298.257223563,'
    'AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],'
    'UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AXIS["Geodetic latitude",NORTH],'
    'AXIS["Geodetic longitude",EAST],AXIS["Ellipsoidal height",UP],AUTHORITY["EPSG","4979"]]'
)
_NAME_3D = "WGS 84 with heights above the ellipsoid"
SYSTEMS = (
    ("WGS 84 geodetic", WGS84, "EPSG", WGS84, _WKT, "longitude and latitude in degrees on WGS 84"),
    ("Undefined Cartesian SRS", -1, "NONE", -1, "undefined", "undefined Cartesian coordinates"),
    ("Undefined geographic SRS", 0, "NONE", 0, "undefined", "undefined geographic coordinates"),
)
"""Rows of gpkg_spatial_ref_sys; the standard requires all of them."""
SYSTEM_3D = (_NAME_3D, WGS84_3D, "EPSG", WGS84_3D, _WKT_3D, _NAME_3D)
"""Row of gpkg_spatial_ref_sys for heights."""


def write(
    path: Path,
    fill: Callable[[sqlite3.Connection], object],
    write_file: Callable[[Path, Callable[[Path], object]], None] = files.write,
) -> None:
    """Write a GeoPackage; `fill` writes its rows. An existing file is replaced when the new one is complete.

    Parameters
    ----------
    write_file
        Writer of the file: `files.write` or `output.write`.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """

    def put(part: Path) -> None:
        with contextlib.closing(sqlite3.connect(part, isolation_level=None)) as base:
            base.executescript("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; BEGIN;")
            base.execute(f"PRAGMA application_id = {_APPLICATION_ID}")
            base.execute(f"PRAGMA user_version = {_USER_VERSION}")
            create_tables(base, _TABLES)
            fill(base)
            base.execute("COMMIT")

    write_file(path, put)


def create_tables(base: sqlite3.Connection, commands: str) -> None:
    """Execute commands that end in ";" and a newline."""
    for command in commands.split(";\n"):
        base.execute(command)


def insert(base: sqlite3.Connection, table: str, rows: Iterable[Sequence[Any]], *columns: str) -> None:
    """Insert rows with values of all columns, or of the named ones."""
    listed = list(rows)
    if listed:
        named = f" ({', '.join(columns)})" if columns else ""
        marks = ", ".join("?" * len(listed[0]))
        base.executemany(f"INSERT INTO {table}{named} VALUES ({marks})", listed)


def add_features(
    base: sqlite3.Connection,
    table: str,
    title: str,
    changed: str,
    geometry: str,
    points: Array,
    z: bool = False,
    m: bool = False,
) -> None:
    """List a feature table whose geometry is in the column "geom".

    Parameters
    ----------
    changed
        Time of change, ISO 8601.
    geometry
        Type, such as POINT.
    points
        (n, 2) degrees east and north of all features.
    """
    srs = WGS84_3D if z else WGS84
    content = (table, "features", table, title, changed, *bounds(points), srs)
    insert(base, "gpkg_contents", [content])
    insert(base, "gpkg_geometry_columns", [(table, "geom", geometry, srs, int(z), int(m))])


def add_attributes(base: sqlite3.Connection, table: str, title: str, changed: str) -> None:
    """List a table without geometry."""
    insert(base, "gpkg_contents", [(table, "attributes", table, title, changed, *[None] * 5)])


def bounds(points: Array) -> list[float | None]:
    """Compute west, south, east and north of points (n, 2); None without any."""
    return [*points.min(axis=0).tolist(), *points.max(axis=0).tolist()] if len(points) else [None] * 4


def flatten(shape: Any) -> list[Array]:
    """List the arrays of coordinates of a geometry."""
    if isinstance(shape, np.ndarray):
        return [shape]
    return [points for part in shape for points in flatten(part)]


def point(latitude: float, longitude: float) -> bytes:
    """Encode a point without an envelope."""
    return _POINT.pack(b"GP", 0, _LITTLE, WGS84, 1, _CODES["POINT"], longitude, latitude)


def position(blob: bytes) -> tuple[float, float] | None:
    """Decode latitude and longitude of a point as `point` and GDAL write it; None for another blob."""
    if len(blob) != _POINT.size:
        return None
    magic, _, flags, _, order, kind, x, y = _POINT.unpack(blob)
    if magic != b"GP" or flags != _LITTLE or order != 1 or kind != _CODES["POINT"]:
        return None
    return y, x


def encode(geometry: str, shape: Any, z: bool = False, m: bool = False) -> bytes:
    """Encode a geometry of a type, with its envelope, as ISO well-known binary."""
    parts, srs = flatten(shape), WGS84_3D if z else WGS84
    body = _body(geometry, shape, 1000 * z + 2000 * m)
    if not parts:
        return _HEADER.pack(b"GP", 0, _LITTLE | _EMPTY, srs) + body
    west, south, east, north = bounds(np.concatenate([points[:, :2] for points in parts]))
    return (
        _HEADER.pack(b"GP", 0, _LITTLE | _BOX_XY, srs) + struct.pack("<4d", west, east, south, north) + body
    )


def _body(geometry: str, shape: Any, more: int) -> bytes:
    code = _CODES[geometry] + more
    if geometry == "POINT":
        return struct.pack("<BI", 1, code) + shape.astype("<f8").tobytes()
    if geometry == "LINESTRING":
        return struct.pack("<BI", 1, code) + _line(shape)
    if geometry == "POLYGON":
        return _SHAPE.pack(1, code, len(shape)) + b"".join(map(_line, shape))
    parts = (_body(geometry.removeprefix("MULTI"), part, more) for part in shape)
    return _SHAPE.pack(1, code, len(shape)) + b"".join(parts)


def _line(points: Array) -> bytes:
    return struct.pack("<I", len(points)) + points.astype("<f8").tobytes()
