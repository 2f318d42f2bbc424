"""Station files of Firetwin: read unchanged, so that other files can be added."""

from __future__ import annotations

import contextlib
import sqlite3
from pathlib import Path

from .. import reading
from ..import_rows import Batch

NAME = "station file"


def sniff(path: Path, head: bytes) -> bool:
    """Return True for a GeoPackage with Firetwin's tables."""
    if not head.startswith(b"SQLite format 3\0"):
        return False
    with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as base:
        try:
            tables = {name for (name,) in base.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
        except sqlite3.DatabaseError:
            return False
    return tables >= {"station", "resource", "source", "availability"}


def read(path: Path) -> Batch:
    """Read a station file."""
    return Batch(station_file=reading.read(path), name=NAME)
