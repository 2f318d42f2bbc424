"""GeoPackage of an export: feature tables with dates, and their QGIS styles."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import geopackage
from ..run import times

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
        Geometry (see `geopackage`) and values of each feature.
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
        return geopackage.WGS84_3D if self.z else geopackage.WGS84

    def points(self) -> NDArray[np.float64]:
        """Return degrees east and north (n, 2) of all features."""
        flat = [points[:, :2] for shape, _ in self.rows for points in geopackage.flatten(shape)]
        return np.concatenate(flat) if flat else np.empty((0, 2))


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
    changed = times.iso(when, "milliseconds")

    def fill(base: sqlite3.Connection) -> None:
        geopackage.insert(base, "gpkg_spatial_ref_sys", (*geopackage.SYSTEMS, geopackage.SYSTEM_3D))
        for table in tables:
            _fill(base, table, changed)
        if styles:
            base.execute(_STYLES)
            geopackage.add_attributes(base, "layer_styles", "QGIS styles", changed)
            rows = [
                (number, "", "", name, "geom", name, qml, "", 1, "", "", None, changed)
                for number, (name, qml) in enumerate(styles.items(), 1)
            ]
            geopackage.insert(base, "layer_styles", rows)

    geopackage.write(path, fill)


def _fill(base: sqlite3.Connection, table: Table, changed: str) -> None:
    columns = "".join(f", {name} {kind}" for name, kind in table.columns.items())
    base.execute(
        f"CREATE TABLE {table.name} (fid INTEGER PRIMARY KEY NOT NULL, geom {table.geometry}{columns})"
    )
    geopackage.add_features(
        base, table.name, table.title, changed, table.geometry, table.points(), table.z, table.m
    )
    rows = [
        (number, geopackage.encode(table.geometry, shape, table.z, table.m), *values)
        for number, (shape, values) in enumerate(table.rows, 1)
    ]
    geopackage.insert(base, table.name, rows)
