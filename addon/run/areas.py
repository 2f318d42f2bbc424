"""Areas and sizes of grid cells on the WGS84 ellipsoid."""

from __future__ import annotations

import numpy as np
from firetwin_core import constants
from numpy.typing import ArrayLike, NDArray

A, E2 = constants.SEMI_MAJOR_AXIS, constants.ECCENTRICITY_SQUARED
_ALONE = 100.0  # m, side of a cell that nothing says the size of


def edges(axis: ArrayLike) -> NDArray[np.float64]:
    """Edges (n + 1,) of the cells whose centres are `axis` (n,): half-way, and as far out at both ends."""
    axis = np.asarray(axis, dtype=np.float64)
    if axis.size == 1:
        return np.array([axis[0], axis[0]])  # one centre alone does not say how wide its cell is
    middle = (axis[1:] + axis[:-1]) / 2
    return np.concatenate([[2 * axis[0] - middle[0]], middle, [2 * axis[-1] - middle[-1]]])


def cell_areas(latitude: ArrayLike, longitude: ArrayLike) -> NDArray[np.float64]:
    """Area (ny, nx) in m2 of each cell of a latitude-longitude grid (centres, degrees)."""
    strip, width = area_factors(latitude, longitude)
    return strip[:, None] * width[None, :]


def area_factors(
    latitude: ArrayLike, longitude: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Factors of the area (m2) of each cell: one of its row (ny,), one of its column (nx,).

    Exact for the ellipsoid: between two parallels lie a^2/2 (q_high - q_low) per radian of longitude, where q
    is that of the authalic latitude (Snyder, Map Projections, USGS Professional Paper 1395, 1987, eq. 3-12).
    """
    sine = np.sin(np.radians(edges(latitude)))
    e = np.sqrt(E2)
    q = (1 - E2) * (sine / (1 - E2 * sine**2) + np.arctanh(e * sine) / e)
    width = np.radians(np.diff(edges(longitude)))
    return np.abs(A * A / 2 * np.diff(q)), np.abs(width)


def metres_per_degree(latitude: float) -> tuple[float, float]:
    """Metres per degree of latitude and longitude: radii of curvature (Snyder 1987, eqs. 4-18 and 4-20)."""
    sine = np.sin(np.radians(latitude))
    w = np.sqrt(1.0 - E2 * sine * sine)
    degree = np.pi / 180.0
    return A * (1.0 - E2) / w**3 * degree, A / w * np.cos(np.radians(latitude)) * degree


def turned(longitude: ArrayLike, middle: float) -> NDArray[np.float64]:
    """The same meridians (degrees east) within half a turn of `middle`; those that are keep their bits.

    A run over the antimeridian counts on past 180, and who asks it about a place may not.
    """
    longitude = np.asarray(longitude, np.float64)
    return longitude - 360.0 * np.round((longitude - middle) / 360.0)


def spacing(latitude: ArrayLike, longitude: ArrayLike, at: float | None = None) -> tuple[float, float]:
    """Mean width and height (m) of a cell at the parallel `at`, else at the middle of the grid.

    An axis of one value does not say how wide its cell is: 0.
    """
    latitude, longitude = np.asarray(latitude, np.float64), np.asarray(longitude, np.float64)
    north, east = metres_per_degree((latitude[0] + latitude[-1]) / 2 if at is None else at)
    height = north * abs(float(latitude[-1] - latitude[0])) / max(latitude.size - 1, 1)
    width = east * abs(float(longitude[-1] - longitude[0])) / max(longitude.size - 1, 1)
    return width, height


def cell_size(
    latitude: ArrayLike,
    longitude: ArrayLike,
    at: float | None = None,
    within: tuple[ArrayLike, ArrayLike] | None = None,
) -> tuple[float, float]:
    """Width and height (m) of a cell to build with, `spacing` where there are two values or more.

    An axis of one value takes the size of the other; a single cell takes those of the coarser grid `within`
    (latitude, longitude) which it is part of, else it is 100 m wide and high.
    """
    width, height = spacing(latitude, longitude, at)
    if within is not None and width == height == 0.0:
        width, height = spacing(*within, at)
    return width or height or _ALONE, height or width or _ALONE
