"""A GeoPackage of made-up stations and resources around the small run or the sample, for tests."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Sequence
from pathlib import Path

TABLES = """
CREATE TABLE source(id INTEGER PRIMARY KEY, name TEXT, licence TEXT, retrieved TEXT, url TEXT, sha256 TEXT);
CREATE TABLE type(code TEXT PRIMARY KEY, kind TEXT, category TEXT, type TEXT, tank_l REAL, payload_kg REAL,
  pump_l_min REAL, people INTEGER, standard TEXT);
CREATE TABLE station(fid INTEGER PRIMARY KEY, geom BLOB, name TEXT, agency TEXT, kind TEXT, address TEXT,
  lat REAL, lon REAL, source INTEGER REFERENCES source, source_id TEXT, origin TEXT NOT NULL, picture TEXT);
CREATE TABLE resource(id INTEGER PRIMARY KEY, station INTEGER REFERENCES station,
  type TEXT REFERENCES type, name TEXT, count INTEGER, load_kg REAL, speed_km_h REAL, mobilise_min REAL,
  radius_km REAL, line_m_h REAL, cost_hour REAL, cost_day REAL, currency TEXT, mode TEXT, night INTEGER,
  origin TEXT NOT NULL, source INTEGER REFERENCES source, note TEXT);
CREATE TABLE availability(resource INTEGER REFERENCES resource, begins TEXT, ends TEXT, status TEXT,
  area TEXT);
"""
TYPES = [
    ("engine/3", "Engine", "", "Type 3", 1893.0, None, 568.0, 3, "PMS 200"),
    ("crew/IHC", "Crew", "Hand", "Type 1 IHC", None, None, None, 18, "PMS 200"),
    ("helicopter/2", "Helicopter", "", "Type 2", None, 1134.0, None, None, "PMS 200"),
]


def write(path: Path, places: Sequence[tuple[str, float, float]], origin: str = "exercise") -> Path:
    """Write stations (name, latitude, longitude), every second with an engine and a crew of an exercise."""
    with contextlib.closing(sqlite3.connect(path)) as base, base:
        base.executescript(TABLES)
        source = (1, "Made up for tests", "CC0-1.0", "2026-01-01", "https://example.org/a", "")
        base.execute("INSERT INTO source VALUES (?, ?, ?, ?, ?, ?)", source)
        base.executemany(f"INSERT INTO type VALUES ({', '.join('?' * 9)})", TYPES)
        for fid, (name, latitude, longitude) in enumerate(places, 1):
            kind = ("fire station", "air base", "lookout")[fid % 3]
            row = (
                fid,
                None,
                name,
                "Exercise agency",
                kind,
                f"{fid} Example Road",
                latitude,
                longitude,
                1,
                "",
                origin,
                "",
            )
            base.execute(f"INSERT INTO station VALUES ({', '.join('?' * 12)})", row)
            if fid % 2:
                add_resources(base, fid)
    return path


def add_resources(base: sqlite3.Connection, station: int) -> None:
    """An engine and a crew of an exercise."""
    for k, (kind, name) in enumerate((("engine/3", "E-31"), ("crew/IHC", "C-2"))):
        row = {
            "id": 10 * station + k,
            "station": station,
            "type": kind,
            "name": f"{name}-{station}",
            "count": 2,
            "speed_km_h": 60.0,
            "mobilise_min": 5.0,
            "cost_hour": 210.0,
            "currency": "USD",
            "mode": "attack",
            "night": 1,
            "origin": "exercise",
            "source": 1,
            "note": "made up",
        }
        marks = ", ".join("?" * len(row))
        base.execute(f"INSERT INTO resource ({', '.join(row)}) VALUES ({marks})", list(row.values()))
        span = "2014-09-17T00:00:00Z", "2014-09-19T00:00:00Z"
        base.execute(
            "INSERT INTO availability VALUES (?, ?, ?, ?, ?)", (row["id"], *span, "available", "Local")
        )
