"""Routes that the user has drawn: lines of a file, within limits."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ... import limits
from ...ellipsoid import metres_per_degree
from ...errors import input_error
from ...run.observations import Detections, Feature, features
from ...stations.records import ORIGINS

_USER = ORIGINS[-1]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Route:
    """A line (n, 2), degrees east and north, and the origin of its data."""

    line: Array
    origin: str


def read(path: Path) -> list[Route]:
    """Read the lines of a file of routes.

    Raises
    ------
    InputError
        The file cannot be read, has no lines or more than the limits.
    """
    lines = [
        Route(line, _origin(each)) for each in read_features(path) for line in each.lines if len(line) > 1
    ]
    if not lines:
        raise input_error(path, "has no lines; draw routes as LineString features")
    length = sum(_length_km(each.line) for each in lines)
    for count, most, what in (
        (len(lines), limits.ROUTES, "lines"),
        (sum(len(each.line) for each in lines), limits.ROUTE_CORNERS, "corners of lines"),
        (length, limits.ROUTE_KM, "km of lines"),
    ):
        if not count <= most:
            reason = f"has {count:,.0f} {what}; at most {most:,} are drawn as routes: keep the main ones"
            raise input_error(path, reason)
    return lines


def _length_km(line: Array) -> float:
    """Compute the length of a line (n, 2), degrees east and north, on a sphere (within 1 %)."""
    step = np.diff(line, axis=0)
    step[:, 0] = (step[:, 0] + 180.0) % 360.0 - 180.0
    north, _ = metres_per_degree(0.0)
    east = north * np.cos(np.radians(0.5 * (line[1:, 1] + line[:-1, 1])))
    return float(np.hypot(step[:, 0] * east, step[:, 1] * north).sum()) / 1000.0


def read_features(path: Path) -> list[Feature]:
    """Read lines and polygons of a file.

    Raises
    ------
    InputError
        The file cannot be read, or has satellite detections.
    """
    found = features(path)
    if isinstance(found, Detections):
        raise input_error(path, "has satellite detections; name a file of lines or polygons")
    return found


def _origin(feature: Feature) -> str:
    given = str(feature.properties.get("origin", _USER))
    return given if given in ORIGINS else _USER
