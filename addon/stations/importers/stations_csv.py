"""Stations of the user: CSV with name, latitude and longitude, and optional columns."""

from __future__ import annotations

from pathlib import Path

from ...errors import input_error
from .. import import_rows
from ..import_rows import Batch, Draft
from ..records import ORIGINS
from . import tables

NAME = "CSV of stations"

_NAMES = {
    "name": {"name", "station", "title"},
    "latitude": {"latitude", "lat", "y"},
    "longitude": {"longitude", "lon", "lng", "long", "x"},
    "kind": {"kind", "type"},
    "agency": {"agency", "operator", "department"},
    "address": {"address"},
    "source_id": {"id", "number", "source_id", "ref"},
    "origin": {"origin"},
}
_NEEDED = ("name", "latitude", "longitude")


def sniff(path: Path, head: bytes) -> bool:
    """Return True if the first line names the three columns."""
    found = tables.columns(head)
    return all(_NAMES[need] & found for need in _NEEDED)


def read(path: Path) -> Batch:
    """Read all stations; their origin is ``user``, unless a column gives another."""
    batch = Batch(name=path.stem, dropped=import_rows.private_columns(tables.read_header(path).values()))
    for line, row in tables.rows(path, _NAMES, _NEEDED, "name, latitude and longitude (degrees)"):
        origin = row.get("origin", "").strip().lower() or "user"
        if origin not in ORIGINS:
            raise input_error(path, f'has origin "{origin}"; use one of {", ".join(ORIGINS)}', line=line)
        draft = Draft(
            row["name"], 0.0, 0.0, kind=row.get("kind", "").strip() or "fire station",
            agency=row.get("agency", ""), address=row.get("address", ""),
            source_id=row.get("source_id", "").strip(), origin=origin, place=f"line {line}",
        )  # fmt: skip
        import_rows.add(batch, row["latitude"], row["longitude"], draft)
    return batch
