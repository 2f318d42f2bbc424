"""Resources of a GeoPackage of places: tables `resource`, `station` and, if there, `availability`."""

from __future__ import annotations

import contextlib
import sqlite3
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ...errors import input_error
from .resources import Unit

_RESOURCES = (
    "SELECT r.id AS id, r.type AS type, coalesce(r.name, s.name) AS name, r.count AS count, "
    "r.line_m_h AS line_m_h, r.mobilise_min AS mobilise_min, r.speed_km_h AS speed_km_h, "
    "r.cost_hour AS cost_hour, r.currency AS currency, r.origin AS origin, s.lat AS lat, s.lon AS lon "
    "FROM resource r JOIN station s ON s.fid = r.station"
)
_AVAILABILITY = "SELECT resource, begins, ends, status FROM availability"
_NUMBERS = ("line_m_h", "mobilise_min", "speed_km_h", "cost_hour", "lat", "lon")
_MOST = 10_000  # units of one row


def read(path: Path, moment: datetime) -> tuple[list[Unit], list[str]]:
    """Units that are available at a time, and sentences on those that are not.

    A row of several units gives as many, with ids such as 7-1 and 7-2. A resource without availability is
    available.

    Raises
    ------
    InputError
        The file has no such tables, or a row has no number where one has to be.
    """
    path.stat()  # raises for a missing file; SQLite would create one
    try:
        with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as base:
            base.row_factory = sqlite3.Row
            rows = base.execute(_RESOURCES).fetchall()
            has = base.execute("SELECT 1 FROM sqlite_master WHERE name = 'availability'").fetchone()
            spans = base.execute(_AVAILABILITY).fetchall() if has else []
    except sqlite3.Error as error:
        reason = f"has no resources and stations to allocate ({error}); name a file of places of Firetwin"
        raise input_error(path, 0, 0, reason) from None
    units: list[Unit] = []
    left: list[str] = []
    for row in rows:
        known = [span for span in spans if span["resource"] == row["id"]]
        status = _status(path, known, moment)
        if status == "available":
            units += _units(path, row)
        else:
            left.append(f"{row['id']} ({row['type']}) is {status}")
    _one_currency(path, units)
    return units, left


def _status(path: Path, spans: list[sqlite3.Row], moment: datetime) -> str:
    """Status at a time, in small letters."""
    for span in spans:
        begins, ends = (_time(path, span[name], end) for name, end in (("begins", False), ("ends", True)))
        if begins <= moment < ends:
            return str(span["status"]).lower()
    return "not available then" if spans else "available"


def _time(path: Path, text: Any, end: bool) -> datetime:
    if text is None:
        return (datetime.max if end else datetime.min).replace(tzinfo=UTC)
    try:
        found = datetime.fromisoformat(str(text))
    except ValueError:
        raise input_error(
            path, 0, 0, f'availability has "{text}", no time such as 2014-09-17T23:00:00Z'
        ) from None
    return found if found.tzinfo else found.replace(tzinfo=UTC)


def _units(path: Path, row: sqlite3.Row) -> list[Unit]:
    numbers = {name: _number(path, row, name) for name in _NUMBERS}
    count = 1 if row["count"] is None else row["count"]
    if not isinstance(count, int) or not 0 <= count <= _MOST:
        raise input_error(path, 0, 0, f"resource {row['id']} has a count of {count}, not of 0 to {_MOST:,}")
    more = {
        "name": row["name"] or "",
        "origin": row["origin"] or "exercise",
        "currency": row["currency"] or "",
    }
    one = Unit(str(row["id"]), str(row["type"]), **numbers, **more)  # type: ignore[arg-type]
    return [one._replace(id=f"{row['id']}-{k}") for k in range(1, count + 1)] if count != 1 else [one]


def _number(path: Path, row: sqlite3.Row, name: str) -> float | None:
    value = row[name]
    if value is None and name not in ("lat", "lon"):
        return None
    if not isinstance(value, int | float):
        raise input_error(
            path, 0, 0, f"resource {row['id']} has {name} = {value!r}, no number; correct the row"
        )
    return float(value)


def _one_currency(path: Path, units: list[Unit]) -> None:
    names = sorted({unit.currency for unit in units if unit.currency})
    if len(names) > 1:
        reason = f"has costs in {' and '.join(names)}; an allocation needs one currency: convert them"
        raise input_error(path, 0, 0, reason)
