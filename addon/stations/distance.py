"""Distances on the WGS84 ellipsoid, and points in areas."""

from __future__ import annotations

import numpy as np
from firetwin_core import geo
from numpy.typing import ArrayLike, NDArray

from ..geometry.polygons import inside
from ..run import areas
from .records import Area

Array = NDArray[np.float64]


def distance_km(latitude: ArrayLike, longitude: ArrayLike, near: tuple[float, float]) -> Array:
    """Compute the distance (n,) of points to a point, km, along the ellipsoid; degrees north and east."""
    return geo.geodesic_inverse(latitude, longitude, *near)[0] / 1000.0


def covers(area: Area, latitude: float, longitude: float) -> bool:
    """Return True if a point is in an area: within an odd number of rings of one of its polygons."""
    polygons = (
        [np.column_stack([areas.turned(ring[:, 0], longitude), ring[:, 1]]) for ring in rings]
        for rings in area.polygons
    )
    return any(inside(rings, np.array([[longitude, latitude]]))[0] for rings in polygons)
