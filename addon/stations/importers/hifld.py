"""Fire stations of HIFLD (Homeland Infrastructure Foundation-Level Data, HSIP Freedom): CSV or GeoJSON.

Columns ID, SECCLASS, NAME, TELEPHONE, ADDRESS, CITY, STATE, ZIP, COUNTY, FIPS, EMERGTITLE, CONTDATE, GEODATE,
GEOPREC, NAICSCODE, NAICSDESCR, X, Y, OWNER. Telephones, titles and owners are not read.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...run.observations import geojson
from .. import import_rows
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch, Draft
from . import positions, tables

NAME, ORDER = "HIFLD fire stations", 30
LICENCE = "public domain (HIFLD: free of licence)"
URL = "https://hifld-geoplatform.hub.arcgis.com"

_BEFORE = b"\xef\xbb\xbf \r\n"
_MARKS = {"name", "naicscode", "geoprec"}


def sniff(path: Path, head: bytes) -> bool:
    """Return True if the columns or properties are from HIFLD."""
    if tables.columns(head) >= _MARKS:
        return True
    marks = [f'"{mark}"'.encode() for mark in _MARKS]
    return head.lstrip(_BEFORE).startswith(b"{") and all(mark in head.lower() for mark in marks)


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read all stations."""
    batch = Batch(name=NAME, licence=LICENCE, url=URL)
    if _first_line(path).lstrip().startswith("{"):
        _read_features(path, batch, options.crs)
    else:
        _read_table(path, batch, options.crs)
    return batch


def _read_features(path: Path, batch: Batch, crs: str) -> None:
    names: set[str] = set()
    for feature in geojson.read(path, crs):
        row = {str(key).lower(): value for key, value in feature.properties.items()}
        names |= set(map(str, feature.properties))
        x, y = feature.points[0] if len(feature.points) else (row.get("x"), row.get("y"))
        import_rows.add(batch, y, x, _draft(batch, row, feature.place))
    batch.dropped = import_rows.private_columns(names)


def _read_table(path: Path, batch: Batch, crs: str) -> None:
    with path.open(encoding="utf-8-sig", newline="") as file:
        reader = csv.reader(file, delimiter=max(",;\t", key=_first_line(path).count))
        names = [name.strip() for name in next(reader)]
        low = [name.lower() for name in names]
        rows = []
        for values in reader:
            if any(value.strip() for value in values):
                row = dict(zip(low, values, strict=False))
                x, y = row.get("longitude") or row.get("x"), row.get("latitude") or row.get("y")
                rows.append(positions.Row(x, y, _draft(batch, row, f"line {reader.line_num}")))
    positions.add_rows(path, batch, rows, crs)
    batch.dropped = import_rows.private_columns(names)


def _first_line(path: Path) -> str:
    with path.open(encoding="utf-8-sig") as file:
        return file.readline()


def _draft(batch: Batch, row: Mapping[str, Any], place: str) -> Draft:
    address = [_text(row, key) for key in ("address", "city", "state", "zip")]
    draft = Draft(
        _text(row, "name"), 0.0, 0.0,
        address=", ".join(each for each in address if each), source_id=_text(row, "id"), place=place,
    )  # fmt: skip
    newest = _text(row, "geodate")[:10].replace("/", "-")
    if len(newest) == 10 and newest[4] == "-":
        batch.retrieved = max(batch.retrieved, newest)
    return draft


def _text(row: Mapping[str, Any], key: str) -> str:
    """Return the text of a column; HIFLD writes NOT AVAILABLE and -999 for missing values."""
    value = str(row.get(key) if row.get(key) is not None else "").strip()
    return "" if value.upper() in ("NOT AVAILABLE", "UNKNOWN", "-999", "NONE", "NULL") else value
