"""CSV tracks: a header line, then one line per point."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

from ...errors import input_error
from ...run import tables
from .track_point import Point, moment, number

_NAMES = {
    "latitude": {"latitude", "lat"},
    "longitude": {"longitude", "lon", "lng", "long"},
    "height": {"height", "altitude", "alt", "elevation", "ele"},
    "time": {"time", "timestamp", "datetime", "utc"},
    "at": {"at"},
}
_COLUMNS = "latitude, longitude, height (m above the sea) and time (2014-09-17T21:30:00Z) or at (0 to 1)"


def points(path: Path) -> Iterator[Point]:
    """Read the points of a CSV file separated by commas, semicolons or tabs."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            for line, value in tables.rows(path, file, _NAMES, ("latitude", "longitude"), _COLUMNS):
                yield _point(path, line, value)
    except UnicodeDecodeError:
        raise input_error(path, "is not UTF-8 text; save it as CSV (UTF-8)") from None


def _point(path: Path, line: int, value: dict[str, str]) -> Point:
    latitude, longitude = (number(path, line, value[name], name) for name in ("latitude", "longitude"))
    height = number(path, line, value["height"], "height") if value.get("height", "").strip() else None
    return Point(line, latitude, longitude, height, moment=_moment(path, line, value))


def _moment(path: Path, line: int, value: dict[str, str]) -> datetime | float | None:
    """Time of a point: UTC, fraction of the shot, or None."""
    if value.get("time", "").strip():
        return moment(path, line, value["time"], zone=True)
    if value.get("at", "").strip():
        part = number(path, line, value["at"], "part of the shot (at)")
        if not 0.0 <= part <= 1.0:
            raise input_error(
                path, f"at is {part:g}; it goes from 0 (first frame) to 1 (last frame)", line=line
            )
        return part
    return None
