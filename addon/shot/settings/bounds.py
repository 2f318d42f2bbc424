"""Bounds that several keys share: lengths and places on or near the Earth, and names of files."""

from __future__ import annotations

import re
from typing import TypedDict

HIGHEST = 1_000_000  # m; satellites in low orbits fly there, and scenes are numbers of 32 bits (0.06 m there)
LONGEST_NAME = 40  # letters: with run, pass and frame a file's name stays under 255, and Blender's under 64


class Bounds(TypedDict, total=False):
    """What such keys hand to `schema.key`."""

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
SENSOR: Bounds = {"unit": "mm", "at_least": 1, "at_most": 1000}  # Blender has none below 1

_DEVICES = re.compile(r"con|prn|aux|nul|com\d|lpt\d", re.IGNORECASE)  # no files' names on Windows


def file_name(value: str) -> str | None:
    """What is wrong with a text that becomes a part of files' names, or None."""
    if len(value) > LONGEST_NAME:
        return f"names files, so it has at most {LONGEST_NAME} letters, not {len(value)}"
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]*", value):
        return f'"{value}" names files, so it is made of letters, digits, - and _'
    if _DEVICES.fullmatch(value):
        return f'"{value}" is a device on Windows and can name no file; choose another name'
    return None


def twice(names: list[str]) -> int | None:
    """Index of the first name that a file system without capitals takes for an earlier one."""
    folded = [name.lower() for name in names]
    return next((i for i, name in enumerate(folded) if name in folded[:i]), None)
