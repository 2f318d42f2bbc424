"""Boxes (x0, y0, x1, y1) of labels and symbols on a picture or a sheet."""

from __future__ import annotations

from collections.abc import Sequence

Box = Sequence[float]


def common_area(one: Box, other: Box) -> float:
    """Compute the common area of two boxes."""
    wide, high = (min(one[k + 2], other[k + 2]) - max(one[k], other[k]) for k in (0, 1))
    return max(wide, 0.0) * max(high, 0.0)


def overlap(one: Box, other: Box) -> bool:
    """Return whether two boxes have a common area."""
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
