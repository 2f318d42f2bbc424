"""GeoPackages as other programs write them: plain SQL and WKB, without our writer."""

import sqlite3
import struct
from contextlib import closing

import numpy as np


def _head(kind):
    return b"GP\0\1" + struct.pack("<iBI", 4326, 1, kind)


def point(longitude, latitude):
    return _head(1) + struct.pack("<dd", longitude, latitude)


def line(points):
    return _head(2) + struct.pack("<I", len(points)) + np.array(points, "<f8").tobytes()


def polygon(*rings):
    parts = [struct.pack("<I", len(ring)) + np.array(ring, "<f8").tobytes() for ring in rings]
    return _head(3) + struct.pack("<I", len(rings)) + b"".join(parts)


def write(path, columns, **tables):
    """Write rows (geometry, *values) of tables with these columns, in degrees on WGS84."""
    with closing(sqlite3.connect(path)) as base, base:
        base.executescript(
            """CREATE TABLE gpkg_spatial_ref_sys (srs_name, srs_id INTEGER, organization,
organization_coordsys_id INTEGER, definition, description);
INSERT INTO gpkg_spatial_ref_sys VALUES ('', 4326, 'EPSG', 4326, '', '');
CREATE TABLE gpkg_geometry_columns (table_name, column_name, geometry_type_name, srs_id, z, m);"""
        )
        for name, rows in tables.items():
            base.execute(
                f"INSERT INTO gpkg_geometry_columns VALUES ('{name}', 'geom', 'GEOMETRY', 4326, 0, 0)"
            )
            base.execute(f"CREATE TABLE {name} (fid INTEGER PRIMARY KEY, geom BLOB, {', '.join(columns)})")
            marks = ", ".join("?" * (1 + len(columns)))
            base.executemany(f"INSERT INTO {name} VALUES (NULL, {marks})", rows)
    return path
