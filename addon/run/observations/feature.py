"""Map features: polygons, lines and points with their properties."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error
from .projection import to_degrees

SAVE_IN_DEGREES = "save it in WGS84 (EPSG:4326)"

Ring = NDArray[np.float64]
Polygon = tuple[Ring, ...]


@dataclass(frozen=True)
class Feature:
    """Map feature: properties, and polygons as lists of rings (n, 2), degrees east and north, outer first.

    `points` (n, 2) belong to a point feature, `lines` (n, 2) to a line feature. `place` is its position
    in the file, for messages.
    """

    polygons: tuple[Polygon, ...]
    properties: Mapping[str, Any]
    place: str = ""
    points: Ring = field(default_factory=lambda: np.empty((0, 2)))
    lines: tuple[Ring, ...] = ()


def ring(path: Path, place: str, points: Iterable[Any], system: str = "") -> Ring:
    """Convert to a ring of at least three corners, closed or not, in degrees (see `degrees`).

    Raises
    ------
    InputError
        The ring is too short, or its numbers are not degrees.
    """
    corners = degrees(path, place, points, system)
    if len(corners) > 1 and (corners[0] == corners[-1]).all():
        corners = corners[:-1]
    if len(corners) < 3:
        raise input_error(path, f"{place} has a ring of {len(corners)} corners; a polygon has three or more")
    return corners


def degrees(path: Path, place: str, points: Iterable[Any], system: str = "") -> Ring:
    """Convert to positions (n, 2) in degrees.

    Parameters
    ----------
    system
        Reference system of the points; empty: degrees on WGS84.

    Raises
    ------
    InputError
        The numbers are not degrees.
    """
    try:
        positions = np.array([(float(point[0]), float(point[1])) for point in points]).reshape(-1, 2)
    except (TypeError, ValueError, OverflowError, IndexError, KeyError):
        raise input_error(
            path, f"{place} has a ring that is not a list of longitudes and latitudes"
        ) from None
    if not len(positions):
        return positions
    if not np.isfinite(positions).all():
        raise input_error(path, f"{place} has a position that is not a number")
    if system:
        positions = to_degrees(path, system, positions)
    wide, high = np.abs(positions).max(axis=0)
    if wide > 540.0 or high > 90.0:
        raise input_error(
            path,
            f"{place} lies at {positions[0, 0]:g}, {positions[0, 1]:g}, not degrees east and north: "
            f"{SAVE_IN_DEGREES}",
        )
    return positions


def finite(value: object) -> float | None:
    """Parse a finite number from a number or text; else None."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None
