"""Tracks in CSV: a line of names, then a line for each point."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

from ..errors import input_error
from .track import Point, moment, number

_NAMES = {
    "latitude": {"latitude", "lat"},
    "longitude": {"longitude", "lon", "lng", "long"},
    "height": {"height", "altitude", "alt", "elevation", "ele"},
    "time": {"time", "timestamp", "datetime", "utc"},
    "at": {"at"},
}
_COLUMNS = "latitude, longitude, height (m above the sea) and time (2014-09-17T21:30:00Z) or at (0 to 1)"


def points(path: Path) -> Iterator[Point]:
    """Points of a CSV file with commas, semicolons or tabs between its values."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            yield from _points(path, file)
    except UnicodeDecodeError:
        raise input_error(path, 0, 0, "is no text in UTF-8; save it as CSV (UTF-8)") from None
    except csv.Error as error:
        raise input_error(path, 0, 0, f"is no CSV: {error}") from None


def _points(path: Path, file: Iterator[str]) -> Iterator[Point]:
    header = next(file, "")
    comma = max(",;\t", key=header.count)
    columns = _columns(path, next(csv.reader([header], delimiter=comma), []))
    reader = csv.reader(file, delimiter=comma)
    for row in reader:
        line = reader.line_num + 1
        if not any(text.strip() for text in row):
            continue
        value = {name: row[k] if k < len(row) else "" for name, k in columns.items()}
        place = (number(path, line, value[name], name) for name in ("latitude", "longitude"))
        height = number(path, line, value["height"], "height") if value.get("height", "").strip() else None
        yield Point(line, *place, height, moment=_moment(path, line, value))


def _columns(path: Path, names: list[str]) -> dict[str, int]:
    """Number of each column that is known; a unit in brackets is no part of a name."""
    plain = [name.partition("(")[0].partition("[")[0].strip().lower() for name in names]
    known = {
        what: next((k for k, n in enumerate(plain) if n in all_of), -1) for what, all_of in _NAMES.items()
    }
    found = {what: k for what, k in known.items() if k >= 0}
    for what in ("latitude", "longitude"):
        if what not in found:
            raise input_error(path, 1, 0, f"the first line names no column {what}; name {_COLUMNS}")
    return found


def _moment(path: Path, line: int, value: dict[str, str]) -> object:
    """UTC, part of the shot, or None."""
    if value.get("time", "").strip():
        return moment(path, line, value["time"], zone=True)
    if value.get("at", "").strip():
        part = number(path, line, value["at"], "part of the shot (at)")
        if not 0.0 <= part <= 1.0:
            raise input_error(
                path, line, 0, f"at is {part:g}; it goes from 0 (first frame) to 1 (last frame)"
            )
        return part
    return None
