"""Track points, and parsing of their times and numbers."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...errors import input_error


class Point(NamedTuple):
    """A track point and its line in the file.

    The height, if any, is m above the sea or the ground. The moment, if any, is UTC or a fraction 0..1 of the
    shot.
    """

    line: int
    latitude: float
    longitude: float
    height: float | None
    over_ground: bool = False
    moment: datetime | float | None = None


def moment(path: Path, line: int, text: str, zone: bool = False) -> datetime:
    """Parse a time as UTC. A time without zone counts as UTC, or is an error if a `zone` is required.

    Raises
    ------
    InputError
        The text is not a time.
    """
    try:
        parsed = datetime.fromisoformat(text.strip())
        if parsed.tzinfo is None and not zone:
            parsed = parsed.replace(tzinfo=UTC)
        if parsed.tzinfo is not None:
            return parsed.astimezone(UTC)
    except (ValueError, OverflowError):
        pass
    raise input_error(path, f'"{text.strip()[:40]}" is not a time such as 2014-09-17T21:30:00Z', line=line)


def number(path: Path, line: int, text: str | None, what: str) -> float:
    """Parse a finite number.

    Raises
    ------
    InputError
        The text is not a finite number.
    """
    try:
        parsed = float(text or "")
    except ValueError:
        parsed = np.nan
    if not np.isfinite(parsed):
        raise input_error(
            path, f'the {what} is "{(text or "").strip()[:40]}", which is not a number', line=line
        )
    return parsed
