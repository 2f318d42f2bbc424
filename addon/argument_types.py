"""Argument types of the command line: each converts a text or explains its error."""

from __future__ import annotations

import argparse
import math
import re
from datetime import UTC, datetime
from pathlib import Path

from . import limits

OUTPUT_PRESETS = ("compositing", "editorial")
"""Names of `shot.settings.output_presets`, known without its imports."""


def name(text: str) -> str:
    """Accept a name that is not blank."""
    if not text.strip():
        raise argparse.ArgumentTypeError("is empty; give a name, or omit the option")
    return text


def path(text: str) -> Path:
    """Convert to a path."""
    if not text:
        raise argparse.ArgumentTypeError("is empty; name a file or a folder")
    return Path(text)


def count(text: str) -> int:
    """Convert to a positive integer."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number above 0, not {text!r}")
    return int(text)


def member(text: str) -> int:
    """Convert the number of a member, 0 or more: ``7`` or ``07``."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"must be the number of a member, such as 07, not {text!r}")
    return int(text)


def architecture(text: str) -> str:
    """Accept the name of an NVIDIA architecture."""
    if not re.fullmatch(r"sm_\d{2,3}", text):
        raise argparse.ArgumentTypeError(f"must be an architecture such as sm_90, not {text!r}")
    return text


def moment(text: str) -> datetime:
    """Convert an ISO 8601 time with its UTC offset to UTC."""
    try:
        value = datetime.fromisoformat(text)
    except ValueError:
        value = None
    if value is None or value.tzinfo is None:
        raise argparse.ArgumentTypeError(
            f"must be a time with its zone, 2014-09-17T16:00-07:00, not {text!r}"
        )
    first, last = limits.RUN_YEARS
    if not first <= value.year <= last:
        raise argparse.ArgumentTypeError(f"must be in the years {first} to {last}, not {text!r}")
    return value.astimezone(UTC)


def factor(text: str) -> float:
    """Convert to a number from 0.1 to 3."""
    return _number(text, 0.1, 3.0, "a number from 0.1 to 3")


def hours(text: str) -> float:
    """Convert to a number of hours above 0, up to a year."""
    return _number(text, math.ulp(0.0), 8784.0, "a number of hours above 0, up to 8784")


def longitude(text: str) -> float:
    """Convert to a longitude, degrees east."""
    return _number(text, -360.0, 360.0, "a number of degrees east from -360 to 360")


def undulation(text: str) -> float:
    """Convert to a height of the geoid above the ellipsoid, m."""
    return _number(text, -200.0, 200.0, "a number of metres from -200 to 200")


def _number(text: str, low: float, high: float, meaning: str) -> float:
    """Convert to a number from `low` to `high`."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise argparse.ArgumentTypeError(f"must be {meaning}, not {text!r}")
    return value


_UNITS = {"": 1, "B": 1, "KB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}


def size(text: str) -> int:
    """Convert a size such as 500MB to bytes."""
    match = re.fullmatch(r"(\d+(?:\.\d+)?) ?([A-Za-z]*)", text.strip(), re.ASCII)
    if not match or match[2].upper() not in _UNITS:
        raise argparse.ArgumentTypeError(f"must be a size such as 500MB or 20GB, not {text!r}")
    return round(float(match[1]) * _UNITS[match[2].upper()])


def resolution(text: str) -> tuple[int, int]:
    """Convert a width and a height, such as ``640x360``, both even."""
    width, _, height = text.lower().partition("x")
    sides = [int(side) if side.isdecimal() else 0 for side in (width, height)]
    if not all(16 <= side <= 16384 and side % 2 == 0 for side in sides):
        raise argparse.ArgumentTypeError(f'"{text}" is not a size such as 640x360, of two even numbers')
    return sides[0], sides[1]
