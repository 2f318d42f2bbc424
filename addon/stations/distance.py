"""Distances on the WGS84 ellipsoid, and points in areas."""

from __future__ import annotations

import numpy as np
from firetwin_core import geo
from numpy.typing import ArrayLike, NDArray

from ..run import areas
from .records import Area

Array = NDArray[np.float64]


def distance_km(latitude: ArrayLike, longitude: ArrayLike, near: tuple[float, float]) -> Array:
    """Compute the distance (n,) of points to a point, km, along the ellipsoid; degrees north and east."""
    return geo.geodesic_inverse(latitude, longitude, *near)[0] / 1000.0


def covers(area: Area, latitude: float, longitude: float) -> bool:
    """Return True if a point is in an area: within an odd number of rings of one of its polygons."""
    return any(sum(_inside(ring, latitude, longitude) for ring in rings) % 2 == 1 for rings in area.polygons)


def _inside(ring: Array, latitude: float, longitude: float) -> bool:
    """Apply the even-odd rule: count how often a line to the east crosses the ring (n, 2)."""
    x, y = areas.turned(ring[:, 0], longitude), ring[:, 1]
    after_x, after_y = np.roll(x, -1), np.roll(y, -1)
    crosses = (y > latitude) != (after_y > latitude)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = x + (latitude - y) / (after_y - y) * (after_x - x)
    return bool(np.count_nonzero(crosses & (at > longitude)) % 2)
