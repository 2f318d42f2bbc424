"""FIRMS: active fire detections of VIIRS and MODIS from NASA, as CSV with UTC times and sizes in km."""

from __future__ import annotations

import csv
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ...errors import input_error
from .. import tables
from . import Detections
from .feature import finite

SUFFIXES = (".csv",)
_NEEDED = ("latitude", "longitude", "acq_date", "acq_time")
_PIXEL = {"VIIRS": 375.0, "MODIS": 1000.0}  # m, pixel size at nadir, for files without scan and track
_LOW = 30.0  # of 100, below which MODIS's confidence class is low


def read(path: Path) -> Detections:
    """Read detections of vegetation fires (`type` 0) that do not have low confidence.

    Raises
    ------
    InputError
        The file is not a FIRMS table, or a row is invalid.
    """
    with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
        tables.read_header(path, file)
        file.seek(0)
        table = csv.DictReader(file)
        names = [name.strip().lower() for name in table.fieldnames or ()]
        if lacking := [name for name in _NEEDED if name not in names]:
            raise input_error(path, f"not detections of FIRMS: missing columns {', '.join(lacking)}", line=1)
        table.fieldnames = names
        rows = [(table.line_num, row) for row in table]
    confident = [(line, row) for line, row in rows if not _low(row)]
    numbers = np.array([_numbers(path, line, row) for line, row in confident]).reshape(-1, 3)
    times = tuple(_time(path, line, row) for line, row in confident)
    return Detections(
        times, numbers[:, 0], numbers[:, 1], numbers[:, 2], path.name, len(rows) - len(confident)
    )


def _low(row: dict[str, str]) -> bool:
    """Check whether confidence is low: class l, n or h of VIIRS, 0 to 100 of MODIS."""
    said = str(row.get("confidence") or "").strip().lower()
    number = finite(said)
    low = said in ("l", "low") if number is None else number < _LOW
    return low or (finite(row.get("type")) or 0.0) > 0.0


def _numbers(path: Path, line: int, row: dict[str, str]) -> tuple[float, float, float]:
    """Parse latitude, longitude, and the pixel's longer side (m)."""
    latitude, longitude = finite(row["latitude"]), finite(row["longitude"])
    if latitude is None or longitude is None or abs(latitude) > 90.0 or abs(longitude) > 360.0:
        raise input_error(path, "its latitude and longitude are not degrees", line=line)
    sides = [finite(row.get(name)) or 0.0 for name in ("scan", "track")]
    if 0.0 < max(sides) < 50.0:
        return latitude, longitude, 1e3 * max(sides)
    text = f"{row.get('instrument') or ''} {row.get('satellite') or ''} {path.name}".upper()
    return latitude, longitude, _PIXEL["VIIRS" if "VIIRS" in text or "NPP" in text else "MODIS"]


def _time(path: Path, line: int, row: dict[str, str]) -> datetime:
    """Parse day and time in UTC; 930, "0930" and "09:30" are all half past nine."""
    day, hour = (row["acq_date"] or "").strip(), (row["acq_time"] or "").strip().replace(":", "").zfill(4)
    for form in ("%Y-%m-%d%H%M", "%Y/%m/%d%H%M", "%m/%d/%Y%H%M"):
        try:
            return datetime.strptime(day + hour, form).replace(tzinfo=UTC)
        except ValueError:
            continue
    raise input_error(path, f'acq_date "{day}" with acq_time "{hour}" is not a time', line=line)
