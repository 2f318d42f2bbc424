"""Distances on the WGS84 ellipsoid, and points in areas."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import E2, A
from ..run import areas
from .records import Area

Array = NDArray[np.float64]

_FLATTENING = 1.0 - np.sqrt(1.0 - E2)


def distance_km(latitude: ArrayLike, longitude: ArrayLike, near: tuple[float, float]) -> Array:
    """Compute the distance (n,) of points to a point, km, along the ellipsoid; degrees north and east.

    Andoyer's and Lambert's correction of the great circle between reduced latitudes (Thomas, Spheroidal
    geodesics, reference systems, and local geometry, US Naval Oceanographic Office SP-138, 1970). Within 1e-5
    of the geodesic for distances to 10,000 km.
    """
    here, there = (np.arctan((1.0 - _FLATTENING) * np.tan(np.radians(at))) for at in (latitude, near[0]))
    turn = np.radians(np.asarray(longitude, np.float64) - near[1])
    mean, half = 0.5 * (here + there), 0.5 * (here - there)
    haversine = np.sin(half) ** 2 + np.cos(here) * np.cos(there) * np.sin(0.5 * turn) ** 2
    haversine = np.clip(haversine, 0.0, 1.0)
    angle = 2.0 * np.arcsin(np.sqrt(haversine))
    sine = np.sin(angle)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = (angle - sine) * (np.sin(mean) * np.cos(half)) ** 2 / (1.0 - haversine)
        y = (angle + sine) * (np.cos(mean) * np.sin(half)) ** 2 / haversine
    return A / 1000.0 * (angle - 0.5 * _FLATTENING * (np.nan_to_num(x) + np.nan_to_num(y)))


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
