"""Detections of fire by VIIRS and MODIS, as NASA's FIRMS writes them: CSV, times UTC, sizes km."""

from __future__ import annotations

import csv
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ...errors import input_error
from . import Detections
from .feature import finite

_NEEDED = ("latitude", "longitude", "acq_date", "acq_time")
_PIXEL = {"VIIRS": 375.0, "MODIS": 1000.0}  # m, at nadir, where a file has no scan and track
_LOW = 30.0  # of 100: MODIS's class of low confidence lies below


def read(path: Path) -> Detections:
    """All detections but those of low confidence, and of what is no vegetation fire (`type` above 0).

    Raises
    ------
    InputError
        It is no table of FIRMS, or a row of it is none.
    """
    with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
        table = csv.DictReader(file)
        names = [name.strip().lower() for name in table.fieldnames or ()]
        if lacking := [name for name in _NEEDED if name not in names]:
            raise input_error(path, 1, 0, f"no detections of FIRMS: there is no column {', '.join(lacking)}")
        table.fieldnames = names
        rows = [(table.line_num, row) for row in table]
    kept = [(line, row) for line, row in rows if not _low(row)]
    found = np.array([_numbers(path, line, row) for line, row in kept]).reshape(-1, 3)
    times = tuple(_time(path, line, row) for line, row in kept)
    return Detections(times, found[:, 0], found[:, 1], found[:, 2], path.name, len(rows) - len(kept))


def _low(row: dict[str, str]) -> bool:
    """Confidence is l, n or h of VIIRS, 0 to 100 of MODIS."""
    said = str(row.get("confidence") or "").strip().lower()
    number = finite(said)
    low = said in ("l", "low") if number is None else number < _LOW
    return low or (finite(row.get("type")) or 0.0) > 0.0


def _numbers(path: Path, line: int, row: dict[str, str]) -> tuple[float, float, float]:
    """Latitude, longitude, and the longer side of the pixel in m."""
    latitude, longitude = finite(row["latitude"]), finite(row["longitude"])
    if latitude is None or longitude is None or abs(latitude) > 90.0 or abs(longitude) > 360.0:
        raise input_error(path, line, 0, "its latitude and longitude are no degrees")
    sides = [finite(row.get(name)) or 0.0 for name in ("scan", "track")]
    if 0.0 < max(sides) < 50.0:
        return latitude, longitude, 1e3 * max(sides)
    text = f"{row.get('instrument') or ''} {row.get('satellite') or ''} {path.name}".upper()
    return latitude, longitude, _PIXEL["VIIRS" if "VIIRS" in text or "NPP" in text else "MODIS"]


def _time(path: Path, line: int, row: dict[str, str]) -> datetime:
    """Day and hour UTC: 930 and "0930" are half past nine, and so is "09:30"."""
    day, hour = (row["acq_date"] or "").strip(), (row["acq_time"] or "").strip().replace(":", "").zfill(4)
    for form in ("%Y-%m-%d%H%M", "%Y/%m/%d%H%M", "%m/%d/%Y%H%M"):
        try:
            return datetime.strptime(day + hour, form).replace(tzinfo=UTC)
        except ValueError:
            continue
    raise input_error(path, line, 0, f'acq_date "{day}" with acq_time "{hour}" is no moment')
