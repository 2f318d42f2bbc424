"""Shared bounds of keys: lengths, positions on or near the Earth, and file names."""

from __future__ import annotations

import re
from typing import TypedDict

HIGHEST = 1_000_000  # m, low Earth orbit; 32-bit scene coordinates resolve 0.06 m there
LONGEST_NAME = 40  # letters: with run, pass and frame a file's name stays under 255, and Blender's under 64


class Bounds(TypedDict, total=False):
    """Arguments of `schema.key` that these keys share."""

    unit: str
    at_least: float
    above: float
    at_most: float


HEIGHT: Bounds = {"unit": "m", "above": 0, "at_most": HIGHEST}
AIM: Bounds = {"unit": "m", "at_least": -12_000, "at_most": HIGHEST}
LENGTH: Bounds = {"unit": "m", "at_least": 1, "at_most": HIGHEST}
CLEARANCE: Bounds = {"unit": "m", "at_least": 0, "at_most": 100_000}
SWATH: Bounds = {"unit": "m", "at_least": 1, "at_most": 10_000_000}
ANGLE: Bounds = {"unit": "degrees", "at_least": -3600, "at_most": 3600}
SENSOR: Bounds = {"unit": "mm", "at_least": 1, "at_most": 1000}  # Blender allows none below 1

_DEVICES = re.compile(r"con|prn|aux|nul|com\d|lpt\d", re.IGNORECASE)  # reserved file names on Windows


def file_name(value: str) -> str | None:
    """Check a text that becomes a part of file names: error message, or None if valid."""
    if len(value) > LONGEST_NAME:
        return f"names files, so it has at most {LONGEST_NAME} letters, not {len(value)}"
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]*", value):
        return f'"{value}" names files, so it is made of letters, digits, - and _'
    if _DEVICES.fullmatch(value):
        return f'"{value}" is a device on Windows and can name no file; choose another name'
    return None


def twice(names: list[str]) -> int | None:
    """Index of the first name that equals an earlier one on a case-insensitive file system, or None."""
    folded = [name.lower() for name in names]
    return next((i for i, name in enumerate(folded) if name in folded[:i]), None)
