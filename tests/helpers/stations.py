"""Files of stations for tests: GeoPackages of a few invented rows."""

import contextlib
import sqlite3
import struct

TABLES = """
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT, srs_id INTEGER PRIMARY KEY, organization TEXT,
  organization_coordsys_id INTEGER, definition TEXT);
CREATE TABLE gpkg_geometry_columns (table_name TEXT, column_name TEXT, geometry_type_name TEXT,
  srs_id INTEGER, z TINYINT, m TINYINT);
INSERT INTO gpkg_spatial_ref_sys VALUES ('WGS 84', 4326, 'EPSG', 4326, '');
INSERT INTO gpkg_geometry_columns VALUES ('station', 'geom', 'POINT', 4326, 0, 0);
CREATE TABLE station (fid INTEGER PRIMARY KEY, geom BLOB, name TEXT, kind TEXT, origin TEXT);
CREATE TABLE resource (id INTEGER PRIMARY KEY, station INTEGER, type TEXT, count INTEGER, speed_km_h REAL,
  mobilise_min REAL, origin TEXT);
"""


def point(longitude, latitude):
    """Blob of a point: header without envelope, then well-known binary."""
    return b"GP\0\x01" + struct.pack("<iBIdd", 4326, 1, 1, longitude, latitude)


def write(path, stations, resources=()):
    """Write stations (fid, name, latitude, longitude, kind, origin), and resources.

    A resource is station, type, count, km/h, minutes, origin.
    """
    with contextlib.closing(sqlite3.connect(path)) as base:
        base.executescript(TABLES)
        for fid, name, latitude, longitude, kind, origin in stations:
            row = fid, point(longitude, latitude), name, kind, origin
            base.execute("INSERT INTO station VALUES (?, ?, ?, ?, ?)", row)
        for row in resources:
            insert = "INSERT INTO resource (station, type, count, speed_km_h, mobilise_min, origin)"
            base.execute(f"{insert} VALUES (?, ?, ?, ?, ?, ?)", row)
        base.commit()
    return path
