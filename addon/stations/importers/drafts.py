"""Stations from the columns of a table or a layer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ...errors import input_error
from ..import_rows import KIND, Batch, Draft
from ..records import ORIGINS
from . import days

_NOTHING = ("", "not available", "unknown", "none", "null", "-999", "n/a", "na", "<null>")


def make_draft(
    path: Path,
    batch: Batch,
    value: Callable[[str], Any],
    column_of: Mapping[str, str],
    place: str,
) -> Draft:
    """Make a station from the values of a row by meaning, and collect the newest date of the batch.

    Raises
    ------
    InputError
        The origin is unknown.
    """

    def text(meaning: str) -> str:
        each = value(column_of[meaning]) if meaning in column_of else None
        plain = " ".join(str(each if each is not None else "").split())
        return "" if plain.lower() in _NOTHING else plain

    origin = text("origin").lower() or "user"
    if origin not in ORIGINS:
        reason = f'has origin "{origin}"; use one of {", ".join(ORIGINS)}'
        raise input_error(path, f"{place} {reason}")
    kind, number = text("kind"), text("source_id").removesuffix(".0")
    if "date" in column_of:
        batch.retrieved = max(batch.retrieved, days.parse_day(value(column_of["date"])))
    return Draft(
        text("name"), 0.0, 0.0, kind=KIND if kind.isdecimal() or not kind else kind, agency=text("agency"),
        address=", ".join(filter(None, map(text, ("address", "city", "state", "zip")))),
        source_id=number, origin=origin, staffing=text("staffing"), place=place,
    )  # fmt: skip


def describe_columns(found: Mapping[str, str]) -> list[str]:
    """Return a message on columns whose name is not the plain word."""
    pairs = [f"{meaning} from {name}" for meaning, name in found.items() if meaning != name.strip().lower()]
    return [f"columns: {', '.join(pairs)}"] if pairs else []
