"""Procedural lines of farmland: field boundaries with hedges, and tracks. Without Blender.

All are functions of position, the same for the ground's material and the plants: rows of fields in a brick
pattern, distorted by sines. Lengths are metres.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

ANGLE = 0.37  # rad, direction of the rows from east
BENDS = (
    (170.0, 3100.0, 0.4),
    (46.0, 830.0, 0.0),
    (14.0, 310.0, 1.7),
)  # amplitude and wavelength of the distortion, its phase
STRETCH = 0.7549  # fraction of a field's length by which rows differ: lengths are 0.6 to 1.6 of it
SHIFT = 0.618  # fraction of a field by which each row is offset against the one before


@dataclass(frozen=True)
class Maths:
    """Mathematical functions of the patterns: NumPy's, or a node tree's."""

    sin: Callable[[Any], Any]
    floor: Callable[[Any], Any]
    fract: Callable[[Any], Any]
    least: Callable[[Any, Any], Any]


NUMPY = Maths(np.sin, np.floor, lambda x: x - np.floor(x), np.minimum)


def distorted(maths: Maths, x: Any, y: Any) -> tuple[Any, Any]:
    """Distorted coordinates along and across the rows, m."""
    along = x * float(np.cos(ANGLE)) + y * float(np.sin(ANGLE))
    across = y * float(np.cos(ANGLE)) - x * float(np.sin(ANGLE))
    for reach, length, phase in BENDS:
        turn = 2.0 * np.pi / length
        along, across = (
            along + maths.sin(across * turn + phase) * reach,
            across + maths.sin(along * (0.8 * turn) + (phase + 1.0)) * reach,
        )
    return along, across


def fields(maths: Maths, x: Any, y: Any, size: tuple[float, float]) -> tuple[Any, Any, Any]:
    """Distance to the boundary of a field (m), and the indices of its row and of the field in its row."""
    along, across = distorted(maths, x, y)
    row = maths.floor(across / size[1])
    long = (maths.fract(row * STRETCH) + 0.6) * size[0]
    shifted = along / long + row * SHIFT
    off = maths.least(_edge(maths, across / size[1]) * size[1], _edge(maths, shifted) * long)
    return off, row, maths.floor(shifted)


def _edge(maths: Maths, x: Any) -> Any:
    """Distance to the nearest integer."""
    part = maths.fract(x)
    return maths.least(part, 1.0 - part)
