"""Areas and sizes of grid cells on the WGS84 ellipsoid."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

A = 6_378_137.0  # semi-major axis, m
E2 = 0.00669437999014  # first eccentricity squared


def edges(axis: ArrayLike) -> NDArray[np.float64]:
    """Edges (n + 1,) of the cells whose centres are `axis` (n,): half-way, and as far out at both ends."""
    axis = np.asarray(axis, dtype=np.float64)
    if axis.size == 1:
        return np.array([axis[0], axis[0]])  # one centre alone does not say how wide its cell is
    middle = (axis[1:] + axis[:-1]) / 2
    return np.concatenate([[2 * axis[0] - middle[0]], middle, [2 * axis[-1] - middle[-1]]])


def cell_areas(latitude: ArrayLike, longitude: ArrayLike) -> NDArray[np.float64]:
    """Area (ny, nx) in m2 of each cell of a latitude-longitude grid (centres, degrees).

    Exact for the ellipsoid: between two parallels lie a^2/2 (q_high - q_low) per radian of longitude, where q
    is that of the authalic latitude (Snyder, Map Projections, USGS Professional Paper 1395, 1987, eq. 3-12).
    """
    sine = np.sin(np.radians(edges(latitude)))
    e = np.sqrt(E2)
    q = (1 - E2) * (sine / (1 - E2 * sine**2) + np.arctanh(e * sine) / e)
    width = np.radians(np.diff(edges(longitude)))
    return np.abs(A * A / 2 * np.diff(q)[:, None] * width[None, :])


def spacing(latitude: ArrayLike, longitude: ArrayLike) -> tuple[float, float]:
    """Mean width and height (m) of a cell at the middle of the grid, from the radii of curvature N and M."""
    latitude, longitude = np.asarray(latitude, np.float64), np.asarray(longitude, np.float64)
    middle = np.radians((latitude[0] + latitude[-1]) / 2)
    w = np.sqrt(1 - E2 * np.sin(middle) ** 2)
    north = np.radians(abs(latitude[-1] - latitude[0])) * A * (1 - E2) / w**3
    east = np.radians(abs(longitude[-1] - longitude[0])) * A / w * np.cos(middle)
    return east / max(longitude.size - 1, 1), north / max(latitude.size - 1, 1)
