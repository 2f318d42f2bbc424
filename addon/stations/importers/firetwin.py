"""Station files of Firetwin: read unchanged, so that other files can be added."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from ... import foreign_database
from .. import reading
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch

NAME, ORDER = "station file", 10


def sniff(path: Path, head: bytes) -> bool:
    """Return True for a GeoPackage with Firetwin's tables."""
    if not head.startswith(b"SQLite format 3\0"):
        return False
    try:
        with foreign_database.opened(path) as base:
            return base.tables() >= {"station", "resource", "source", "availability"}
    except sqlite3.DatabaseError:
        return False


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read a station file."""
    return Batch(station_file=reading.read(path), name=NAME)
