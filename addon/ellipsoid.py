"""Lengths on the WGS84 ellipsoid."""

from __future__ import annotations

import numpy as np
from firetwin_core import constants

A, E2 = constants.SEMI_MAJOR_AXIS, constants.ECCENTRICITY_SQUARED


def metres_per_degree(latitude: float) -> tuple[float, float]:
    """Metres per degree of latitude and longitude: radii of curvature (Snyder 1987, eqs. 4-18 and 4-20)."""
    sine = np.sin(np.radians(latitude))
    w = np.sqrt(1.0 - E2 * sine * sine)
    degree = np.pi / 180.0
    return A * (1.0 - E2) / w**3 * degree, A / w * np.cos(np.radians(latitude)) * degree
