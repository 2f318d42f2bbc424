"""Resources of the user: CSV with station, type and optional columns.

The station is given by name or number, as in a CSV of stations. A row with begins, ends and status is a
window of availability; further rows with the same name and station add windows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ... import limits
from ...errors import input_error
from .. import import_rows, types
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch, ResourceDraft
from ..reading import NUMBERS
from ..records import MODES, ORIGINS, STAFFING, STATUSES, Resource
from . import column_names, tables

NAME, ORDER = "CSV of resources", 50

_NAMES = {
    "station": {"station", "station_id", "base"},
    "type": {"type"},
    "name": {"name", "resource", "title"},
    **{name: {name} for name in (*NUMBERS, "count", "currency", "mode", "staffing", "night")},
    **{name: {name} for name in ("origin", "note", "begins", "ends", "status", "area")},
}
_NEEDED = ("station", "type")
_YES = {"": False, "no": False, "0": False, "false": False, "yes": True, "1": True, "true": True}


def sniff(path: Path, head: bytes) -> bool:
    """Return True if the first line names station and type, and no position."""
    found = tables.columns(head)
    if not all(_NAMES[need] & found for need in _NEEDED):
        return False
    return not column_names.has_position(column_names.find_columns(path, found, {}))


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read all resources; their origin is ``user``, unless a column gives another."""
    batch = Batch(name=path.stem, dropped=import_rows.private_columns(tables.read_header(path).values()))
    help = 'station and type, such as "engine/3"'
    for line, row in tables.rows(path, _NAMES, _NEEDED, help):
        plain = {key: " ".join(value.split()) for key, value in row.items()}
        resource = _resource(path, line, plain)
        window = _window(path, line, plain)
        batch.resources.append(ResourceDraft(resource, plain["station"], f"line {line}", window))
    return batch


def _resource(path: Path, line: int, row: Mapping[str, str]) -> Resource:
    code = row["type"]
    if types.user_type(code) is None:
        raise input_error(
            path, f'has type "{code}"; write kind/type, such as engine/3 or tender/1', line=line
        )
    word = _words(path, line, row)
    name = import_rows.remove_telephones(row.get("name", "")) or code
    return Resource(
        0, 0, code, name, word("origin", ORIGINS, "user"), 0,
        count=_count(path, line, row.get("count", "")),
        **{name: _number(path, line, name, row.get(name, "")) for name in NUMBERS},
        currency=row.get("currency", "").upper() or "USD",
        mode=word("mode", MODES, types.mode_of(code)),
        staffing=word("staffing", STAFFING, ""),
        night=_YES[word("night", tuple(_YES), "")],
        note=import_rows.remove_telephones(row.get("note", "")),
    )  # fmt: skip


def _words(path: Path, line: int, row: Mapping[str, str]) -> Any:
    def word(key: str, known: tuple[str, ...], usual: str) -> str:
        value = row.get(key, "").lower()
        if value and value not in known:
            listed = ", ".join(each for each in known if each)
            raise input_error(path, f'has {key} "{value}"; use one of {listed}', line=line)
        return value or usual

    return word


def _number(path: Path, line: int, name: str, text: str) -> float | None:
    """Parse a number; None if it is empty."""
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not limits.is_quantity(value) or (name == "speed_km_h" and value == 0.0):
        least = "above 0" if name == "speed_km_h" else "of at least 0"
        reason = f"enter a number {least} and at most {limits.LARGEST_NUMBER:,.0f}, or leave it empty"
        raise input_error(path, f'has {name} "{text}"; {reason}', line=line)
    return value


def _count(path: Path, line: int, text: str) -> int:
    if text and not (text.isascii() and text.isdecimal() and 1 <= int(text) <= 10_000):
        raise input_error(path, f'has count "{text}"; enter a whole number from 1 to 10000', line=line)
    return int(text or 1)


def _window(path: Path, line: int, row: Mapping[str, str]) -> tuple[datetime, datetime, str, str] | None:
    if not (row.get("begins") or row.get("ends")):
        if row.get("status"):
            raise input_error(path, "has a status without begins and ends; give both", line=line)
        return None
    begins, ends = (_time(path, line, key, row.get(key, "")) for key in ("begins", "ends"))
    if not begins < ends:
        raise input_error(path, "begins is not before ends; correct one of them", line=line)
    status = _words(path, line, row)("status", STATUSES, "available")
    return begins, ends, status, row.get("area", "")


def _time(path: Path, line: int, key: str, text: str) -> datetime:
    try:
        when = datetime.fromisoformat(text)
    except ValueError:
        when = None
    if when is None or when.tzinfo is None:
        reason = f'has {key} "{text}"; write a time with its zone, 2014-09-17T16:00-07:00'
        raise input_error(path, reason, line=line)
    if not limits.YEARS[0] <= when.year <= limits.YEARS[1]:
        first, last = limits.YEARS
        reason = f'has {key} "{text}"; enter a year from {first} to {last}'
        raise input_error(path, reason, line=line)
    return when.astimezone(UTC)
