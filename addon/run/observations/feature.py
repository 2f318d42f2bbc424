"""A feature of a map: polygons, lines, points and what is written about them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error

Ring = NDArray[np.float64]
Polygon = tuple[Ring, ...]


@dataclass(frozen=True)
class Feature:
    """Polygons, each its rings, the outer first: (n, 2) degrees east and north; and what a file says of them.

    `points` (n, 2) are those of a feature of points, `lines` (n, 2) those of one of lines; `place` is where
    in the file it stands, for messages.
    """

    polygons: tuple[Polygon, ...]
    properties: Mapping[str, Any]
    place: str = ""
    points: Ring = field(default_factory=lambda: np.empty((0, 2)))
    lines: tuple[Ring, ...] = ()


def ring(path: Path, place: str, points: Iterable[Any]) -> Ring:
    """A ring of at least three corners, closed or not, in degrees.

    Raises
    ------
    InputError
        It is none, or its numbers are no degrees.
    """
    found = degrees(path, place, points)
    if len(found) > 1 and (found[0] == found[-1]).all():
        found = found[:-1]
    if len(found) < 3:
        raise input_error(
            path, 0, 0, f"{place} has a ring of {len(found)} corners; a polygon has three or more"
        )
    return found


def degrees(path: Path, place: str, points: Iterable[Any]) -> Ring:
    """Places (n, 2) in degrees.

    Raises
    ------
    InputError
        Their numbers are no degrees.
    """
    try:
        found = np.array([(float(point[0]), float(point[1])) for point in points]).reshape(-1, 2)
    except (TypeError, ValueError, OverflowError, IndexError, KeyError):
        raise input_error(
            path, 0, 0, f"{place} has a ring that is no list of longitudes and latitudes"
        ) from None
    if not len(found):
        return found
    if not np.isfinite(found).all():
        raise input_error(path, 0, 0, f"{place} has a position that is no number")
    wide, high = np.abs(found).max(axis=0)
    if wide > 540.0 or high > 90.0:
        raise input_error(
            path,
            0,
            0,
            f"{place} lies at {found[0, 0]:g}, {found[0, 1]:g}, which are no degrees east and north: "
            "save it in WGS84 (EPSG:4326)",
        )
    return found


def finite(value: object) -> float | None:
    """A number that a file gives as one or as text, else None."""
    try:
        found = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
    return found if math.isfinite(found) else None
