"""Web Mercator (EPSG:3857): the Mercator projection of a sphere with the equatorial radius of WGS84.

x = R lambda, y = R arsinh(tan phi) with R = 6378137 m (IOGP Guidance Note 7-2, method 1024, Popular
Visualisation Pseudo-Mercator).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import A

Array = NDArray[np.float64]


def forward(latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
    """Project degrees to x and y, m."""
    return A * np.radians(longitude), A * np.arcsinh(np.tan(np.radians(latitude)))


def inverse(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Convert x and y (m) to latitude and longitude, degrees."""
    with np.errstate(over="ignore"):  # far beyond the map: a pole
        return np.degrees(np.arctan(np.sinh(np.asarray(y) / A))), np.degrees(np.asarray(x) / A)
