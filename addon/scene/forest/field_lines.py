"""Invented lines of tilled land: edges of fields, which hedges stand on, and tracks. Without Blender.

All are functions of a place, which the ground's material and the plants work out alike: rows of fields as
bricks lie, bent by sines. Lengths are metres.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

ANGLE = 0.37  # rad from east, of the rows
BENDS = (
    (170.0, 3100.0, 0.4),
    (46.0, 830.0, 0.0),
    (14.0, 310.0, 1.7),
)  # amplitude and length of the bends, their phase
STRETCH = 0.7549  # of a field's length, by which rows differ: from 0.6 to 1.6 of it
SHIFT = 0.618  # of a field, by which each row is shifted against the one before


@dataclass(frozen=True)
class Maths:
    """The functions that places are worked out with: NumPy's, or a node tree's."""

    sin: Callable[[Any], Any]
    floor: Callable[[Any], Any]
    fract: Callable[[Any], Any]
    least: Callable[[Any, Any], Any]


NUMPY = Maths(np.sin, np.floor, lambda x: x - np.floor(x), np.minimum)


def bent(maths: Maths, x: Any, y: Any) -> tuple[Any, Any]:
    """Along and across the rows, m."""
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
    """Distance from the edge of a field (m), and the numbers of its row and of it in its row."""
    along, across = bent(maths, x, y)
    row = maths.floor(across / size[1])
    long = (maths.fract(row * STRETCH) + 0.6) * size[0]
    shifted = along / long + row * SHIFT
    off = maths.least(_edge(maths, across / size[1]) * size[1], _edge(maths, shifted) * long)
    return off, row, maths.floor(shifted)


def _edge(maths: Maths, x: Any) -> Any:
    """Distance from the next whole number."""
    part = maths.fract(x)
    return maths.least(part, 1.0 - part)
