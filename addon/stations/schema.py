"""Tables that Firetwin adds to a GeoPackage for a station file.

`station` and `area` are features; the other tables are attributes. Geometry is WGS84. Stations have the
spatial index of the GeoPackage extension (Annex F.3), so that QGIS uses and updates it.
"""

from __future__ import annotations

from .records import MODES, ORIGINS, STATUSES

FEATURES = {"station": "POINT", "area": "MULTIPOLYGON"}
ATTRIBUTES = ("source", "type", "resource", "availability")
INDEX = "rtree_station_geom"


def _one_of(column: str, words: tuple[str, ...]) -> str:
    return f"CHECK ({column} IN ({', '.join(repr(word) for word in words)}))"


TABLES = f"""
CREATE TABLE source (
  id INTEGER PRIMARY KEY, name TEXT NOT NULL, licence TEXT NOT NULL, retrieved TEXT NOT NULL,
  url TEXT NOT NULL, sha256 TEXT NOT NULL);
CREATE TABLE type (
  fid INTEGER PRIMARY KEY, code TEXT NOT NULL UNIQUE, kind TEXT NOT NULL, category TEXT NOT NULL,
  type TEXT NOT NULL, tank_l DOUBLE, payload_kg DOUBLE, pump_l_min DOUBLE, people INTEGER,
  standard TEXT NOT NULL);
CREATE TABLE station (
  fid INTEGER PRIMARY KEY, geom POINT NOT NULL, name TEXT NOT NULL, kind TEXT NOT NULL,
  agency TEXT NOT NULL, address TEXT NOT NULL, source INTEGER NOT NULL REFERENCES source(id),
  source_id TEXT NOT NULL, origin TEXT NOT NULL {_one_of("origin", ORIGINS)}, picture TEXT NOT NULL,
  staffing TEXT NOT NULL DEFAULT '');
CREATE TABLE resource (
  id INTEGER PRIMARY KEY, station INTEGER NOT NULL REFERENCES station(fid),
  type TEXT NOT NULL REFERENCES type(code), name TEXT NOT NULL,
  count INTEGER NOT NULL CHECK (count >= 1), load_kg DOUBLE, speed_km_h DOUBLE, mobilise_min DOUBLE,
  radius_km DOUBLE, line_m_h DOUBLE, cost_mobilise DOUBLE, cost_hour DOUBLE, cost_day DOUBLE,
  currency TEXT NOT NULL, mode TEXT NOT NULL {_one_of("mode", MODES)}, staffing TEXT NOT NULL,
  night BOOLEAN NOT NULL, origin TEXT NOT NULL {_one_of("origin", ORIGINS)},
  source INTEGER NOT NULL REFERENCES source(id), note TEXT NOT NULL);
CREATE TABLE availability (
  id INTEGER PRIMARY KEY, resource INTEGER NOT NULL REFERENCES resource(id), begins DATETIME NOT NULL,
  ends DATETIME NOT NULL, status TEXT NOT NULL {_one_of("status", STATUSES)}, area TEXT NOT NULL);
CREATE TABLE area (
  fid INTEGER PRIMARY KEY, geom MULTIPOLYGON NOT NULL, name TEXT NOT NULL, kind TEXT NOT NULL,
  station INTEGER NOT NULL REFERENCES station(fid));
CREATE VIRTUAL TABLE {INDEX} USING rtree(id, minx, maxx, miny, maxy);
"""

_BOX = "ST_MinX(NEW.geom), ST_MaxX(NEW.geom), ST_MinY(NEW.geom), ST_MaxY(NEW.geom)"
_NEW, _OLD = (f"({row}.geom NOTNULL AND NOT ST_IsEmpty({row}.geom))" for row in ("NEW", "OLD"))


def _trigger(name: str, event: str, when: str, *then: str) -> str:
    lines = " ".join(f"{each};" for each in then)
    return f"CREATE TRIGGER {INDEX}_{name} AFTER {event} ON station WHEN {when} BEGIN {lines} END;\n"


_INSERT = f"INSERT OR REPLACE INTO {INDEX} VALUES (NEW.fid, {_BOX})"
_SET = (
    "minx = ST_MinX(NEW.geom), maxx = ST_MaxX(NEW.geom), miny = ST_MinY(NEW.geom), maxy = ST_MaxY(NEW.geom)"
)
_DELETE = f"DELETE FROM {INDEX} WHERE id = OLD.fid"

TRIGGERS = (
    _trigger("insert", "INSERT", _NEW, _INSERT)
    + _trigger("update2", "UPDATE OF geom", f"OLD.fid = NEW.fid AND NOT {_NEW}", _DELETE)
    + _trigger(
        "update4",
        "UPDATE",
        f"OLD.fid != NEW.fid AND NOT {_NEW}",
        f"DELETE FROM {INDEX} WHERE id IN (OLD.fid, NEW.fid)",
    )
    + _trigger("update5", "UPDATE", f"OLD.fid != NEW.fid AND {_NEW}", _DELETE, _INSERT)
    + _trigger(
        "update6",
        "UPDATE OF geom",
        f"OLD.fid = NEW.fid AND {_NEW} AND {_OLD}",
        f"UPDATE {INDEX} SET {_SET} WHERE id = NEW.fid",
    )
    + _trigger("update7", "UPDATE OF geom", f"OLD.fid = NEW.fid AND {_NEW} AND NOT {_OLD}", _INSERT)
    + _trigger("delete", "DELETE", "OLD.geom NOT NULL", _DELETE)
)
"""Triggers that update the spatial index; their functions come from the editing program, such as QGIS."""

EXTENSION = (
    "station",
    "geom",
    "gpkg_rtree_index",
    "http://www.geopackage.org/spec140/#extension_rtree",
    "write-only",
)
"""Row of gpkg_extensions."""
