"""Lengths, positions and directions on the WGS84 ellipsoid and in Earth-centred axes."""

from __future__ import annotations

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

A, E2 = constants.SEMI_MAJOR_AXIS, constants.ECCENTRICITY_SQUARED
MEAN_RADIUS = 6_371_000.0
"""Radius of the Earth as a sphere, m."""


def metres_per_degree(latitude: float) -> tuple[float, float]:
    """Compute metres per degree of latitude and longitude from the radii of curvature.

    Snyder 1987, eqs. 4-18 and 4-20.
    """
    sine = np.sin(np.radians(latitude))
    w = np.sqrt(1.0 - E2 * sine * sine)
    degree = np.pi / 180.0
    return A * (1.0 - E2) / w**3 * degree, A / w * np.cos(np.radians(latitude)) * degree


def enu_axes(latitude: NDArray[np.float64], longitude: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute east, north and up as rows (n, 3, 3), at latitudes and longitudes in radians."""
    sp, cp, sl, cl = np.sin(latitude), np.cos(latitude), np.sin(longitude), np.cos(longitude)
    zero = np.zeros_like(sp)
    rows = [[-sl, cl, zero], [-sp * cl, -sp * sl, cp], [cp * cl, cp * sl, sp]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def ecef(
    latitude: NDArray[np.float64], longitude: NDArray[np.float64], height: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Convert latitudes, longitudes (radians) and WGS84 heights (m) to Earth-centred positions (n, 3), m."""
    sine, cosine = np.sin(latitude), np.cos(latitude)
    normal = A / np.sqrt(1.0 - E2 * sine * sine)
    across = (normal + height) * cosine
    return np.stack(
        [across * np.cos(longitude), across * np.sin(longitude), (normal * (1.0 - E2) + height) * sine],
        axis=-1,
    )
