"""GeoPackage (OGC 12-128): SQLite feature tables with polygons and points as well-known binary (WKB)."""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ... import foreign_database, limits
from ...errors import input_error
from ...foreign_database import ForeignDatabase
from .feature import Feature, Polygon, Ring, degrees, ring
from .projection import UNDEFINED, to_degrees

SUFFIXES = (".gpkg",)
Part = tuple[str, Polygon | Ring]
_ENVELOPES = (0, 32, 48, 48, 64)  # bytes of the envelope by flag bits


def read(path: Path, system: str = "") -> list[Feature]:
    """Read the rows of all feature tables.

    Parameters
    ----------
    system
        Reference system of tables that name none.

    Raises
    ------
    InputError
        The file is not a GeoPackage, or pyproj is needed and missing.
    """
    path.stat()  # raises for a missing file; SQLite would create one
    try:
        with foreign_database.opened(path) as base:
            return [row for table in _tables(base, system) for row in _rows(path, base, table)]
    except sqlite3.Error as error:
        raise input_error(path, f"not a GeoPackage: {error}") from None


class _Table(NamedTuple):
    """A feature table: its name, its column of geometry, and its reference system."""

    name: str
    shape: str
    system: str


def _tables(base: ForeignDatabase, system: str) -> list[_Table]:
    named = ("srs_id", "organization", "organization_coordsys_id", "definition")
    systems = {
        number: f"{body}:{code}" if isinstance(code, int) and code > 0 else _defined(definition, system)
        for number, body, code, definition in base.rows("gpkg_spatial_ref_sys", named)
    }
    columns = ("table_name", "column_name", "srs_id")
    found = base.rows("gpkg_geometry_columns", columns)
    return [_Table(str(name), str(shape), systems[k]) for name, shape, k in found if k in systems]


def _defined(definition: Any, system: str) -> str:
    return system if str(definition) in UNDEFINED and system else str(definition)


def _rows(path: Path, base: ForeignDatabase, table: _Table) -> Iterator[Feature]:
    names = base.columns(table.name)
    if names and table.shape not in names:
        raise input_error(path, f"table {table.name} has no stored column {table.shape}; export it again")
    for number, values in enumerate(base.rows(table.name), 1):
        row = dict(zip(names, values, strict=True))
        place = f"row {number} of {table.name}"
        blob = row.pop(table.shape)
        parts: dict[str, list[Any]] = {"polygon": [], "line": [], "point": []}
        try:
            for kind, points in [] if blob is None else parts_of(blob):
                parts[kind].append(points)
        except _NoPolygonError:
            parts = {kind: [] for kind in parts}
        except (struct.error, ValueError, IndexError, TypeError):
            raise input_error(path, f"{place} has a damaged geometry") from None
        outlines = tuple(
            tuple(ring(path, place, to_degrees(path, table.system, each)) for each in rings)
            for rings in parts["polygon"]
        )
        spots = degrees(path, place, to_degrees(path, table.system, np.array(parts["point"]).reshape(-1, 2)))
        lines = tuple(degrees(path, place, to_degrees(path, table.system, part)) for part in parts["line"])
        yield Feature(outlines, {"layer": table.name} | row, place, spots, lines)


def parts_of(blob: bytes) -> Iterator[Part]:
    """Parse a geometry blob: bytes "GP", version, flags, srs, envelope, WKB.

    Raises
    ------
    struct.error, ValueError, IndexError, TypeError
        The geometry is damaged.
    """
    if blob[:2] != b"GP":
        raise ValueError("no geometry of a GeoPackage")
    flags = blob[3]
    if flags & 0x10:  # empty
        return
    yield from _Binary(blob, 8 + _ENVELOPES[flags >> 1 & 7]).geometry()


def points(blob: bytes) -> list[Ring]:
    """Decode the points (2,) of a geometry blob, east and north; none if damaged or of another type."""
    return _of_kind(blob, "point")


def polygons(blob: bytes) -> tuple[Polygon, ...]:
    """Decode the polygons of a geometry blob as rings (n, 2), outer first; none if it is damaged."""
    return tuple(
        tuple(each[:-1] if len(each) > 1 and (each[0] == each[-1]).all() else each for each in rings)
        for rings in _of_kind(blob, "polygon")
    )


def _of_kind(blob: bytes, kind: str) -> list[Any]:
    try:
        return [part for found, part in parts_of(blob) if found == kind]
    except (struct.error, ValueError, IndexError, TypeError):
        return []


class _Binary:
    """Parser of well-known binary (ISO 19125): byte order, type, then counts and float64 coordinates."""

    def __init__(self, blob: bytes, at: int) -> None:
        self.blob, self.at, self.order = blob, at, "<"

    def number(self) -> int:
        (value,) = struct.unpack_from(f"{self.order}I", self.blob, self.at)
        self.at += 4
        return value

    def geometry(self, depth: int = 0) -> Iterator[Part]:
        if depth > limits.GEOMETRY_DEPTH:
            raise ValueError(f"more than {limits.GEOMETRY_DEPTH} geometries in one another")
        self.order = "<" if self.blob[self.at] else ">"
        self.at += 1
        kind = self.number()
        flags, kind = kind >> 28, kind & 0x0FFFFFFF
        if flags & 0x2:
            self.at += 4  # an SRID
        more = kind // 1000 + (flags >> 3 & 1) + (flags >> 2 & 1) if flags else (0, 1, 1, 2)[kind // 1000]
        if kind % 1000 == 3:
            rings = tuple(self.ring(2 + more) for _ in range(self.number()))
            if rings:
                yield "polygon", rings
        elif kind % 1000 == 2:
            yield "line", self.ring(2 + more)
        elif kind % 1000 == 1:
            coordinates = np.frombuffer(self.blob, f"{self.order}f8", 2 + more, self.at)
            self.at += (2 + more) * 8
            if np.isfinite(coordinates[:2]).all():  # NaN marks an empty point
                yield "point", coordinates[:2].astype(np.float64)
        elif kind % 1000 in (4, 5, 6, 7):
            for _ in range(self.number()):
                yield from self.geometry(depth + 1)
        else:
            raise _NoPolygonError

    def ring(self, size: int) -> Any:
        count = self.number()
        coordinates = np.frombuffer(self.blob, f"{self.order}f8", count * size, self.at).reshape(count, size)
        self.at += count * size * 8
        return coordinates[:, :2].astype(np.float64)


class _NoPolygonError(ValueError):
    """A geometry of lines."""
