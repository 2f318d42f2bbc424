"""Fire stations of the USGS National Structures Dataset: GeoPackage or GeoJSON.

Points with NAME, ADDRESS, CITY, STATE, ZIPCODE, FTYPE, FCODE, PERMANENT_IDENTIFIER, LOADDATE. Fire stations
are FTYPE 740 (emergency response and law enforcement) with FCODE 74026; other structures are skipped.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ... import foreign_database
from ...run.observations import geojson, geopackage
from .. import import_rows
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch, Draft
from . import days

NAME, ORDER = "USGS National Structures Dataset", 20
LICENCE = "public domain (US Geological Survey)"
URL = "https://www.usgs.gov/national-structures-dataset"

FTYPE, FCODE = 740, 74026
_SQLITE = b"SQLite format 3\0"
_OTHER = f"other structure (FCODE is not {FCODE})"


def sniff(path: Path, head: bytes) -> bool:
    """Return True if there are features with FTYPE and FCODE."""
    if not head.startswith(_SQLITE):
        text = head.lower()
        start = head.lstrip(b"\xef\xbb\xbf \r\n").startswith(b"{")
        return start and b'"fcode"' in text and b'"ftype"' in text
    try:
        with foreign_database.opened(path) as base:
            if "gpkg_geometry_columns" not in base.tables():
                return False
            tables = [str(name) for (name,) in base.rows("gpkg_geometry_columns", ["table_name"])]
            return any({"ftype", "fcode"} <= set(map(str.lower, base.columns(each))) for each in tables)
    except sqlite3.DatabaseError:
        return False


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read the fire stations among all structures."""
    batch = Batch(name=NAME, licence=LICENCE, url=URL)
    names: set[str] = set()
    with path.open("rb") as file:
        binary = file.read(len(_SQLITE)) == _SQLITE
    for feature in (geopackage if binary else geojson).read(path, options.crs):
        row = {str(key).lower(): value for key, value in feature.properties.items()}
        names |= set(map(str, feature.properties))
        if _number(row.get("fcode")) != FCODE or _number(row.get("ftype")) not in (FTYPE, None):
            batch.rejected.add(_OTHER, feature.place)
            continue
        x, y = feature.points[0] if len(feature.points) else (None, None)
        address = [_text(row, key) for key in ("address", "city", "state", "zipcode")]
        draft = Draft(
            _text(row, "name"), 0.0, 0.0, address=", ".join(each for each in address if each),
            source_id=_text(row, "permanent_identifier"), place=feature.place,
        )  # fmt: skip
        import_rows.add(batch, y, x, draft)
        batch.retrieved = max(batch.retrieved, days.parse_day(row.get("loaddate")))
    batch.dropped = import_rows.private_columns(names)
    return batch


def _text(row: Mapping[str, Any], key: str) -> str:
    value = row.get(key)
    return "" if value is None else str(value).strip()


def _number(value: Any) -> int | None:
    try:
        return int(float(value))
    except (TypeError, ValueError, OverflowError):
        return None
