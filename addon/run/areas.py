"""Cell areas and sizes of latitude-longitude grids on the WGS84 ellipsoid."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import E2, A, metres_per_degree

_ALONE = 100.0  # m, side of a single cell of unknown size


def edges(axis: ArrayLike) -> NDArray[np.float64]:
    """Compute cell edges (n + 1,) from centres `axis` (n,): midpoints, extrapolated at both ends."""
    axis = np.asarray(axis, dtype=np.float64)
    if axis.size == 1:
        return np.array([axis[0], axis[0]])  # a single centre has no cell width
    middle = (axis[1:] + axis[:-1]) / 2
    return np.concatenate([[2 * axis[0] - middle[0]], middle, [2 * axis[-1] - middle[-1]]])


def cell_areas(latitude: ArrayLike, longitude: ArrayLike) -> NDArray[np.float64]:
    """Compute the area (ny, nx) in m2 of each cell of a latitude-longitude grid (centres, degrees)."""
    strip, width = area_factors(latitude, longitude)
    return strip[:, None] * width[None, :]


def area_factors(
    latitude: ArrayLike, longitude: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Compute separable cell areas (m2): factors of the rows (ny,) and of the columns (nx,).

    Exact for the ellipsoid: between two parallels lie a^2/2 (q_high - q_low) per radian of longitude, where q
    belongs to the authalic latitude (Snyder, Map Projections, USGS Professional Paper 1395, 1987, eq. 3-12).
    An axis with a single value has a cell of `cell_size`.
    """
    rows, columns = _wide_edges(latitude, longitude)
    sine = np.sin(np.radians(rows))
    e = np.sqrt(E2)
    q = (1 - E2) * (sine / (1 - E2 * sine**2) + np.arctanh(e * sine) / e)
    width = np.radians(np.diff(columns))
    return np.abs(A * A / 2 * np.diff(q)), np.abs(width)


def _wide_edges(latitude: ArrayLike, longitude: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Compute cell edges of both axes (degrees); the cell of a single value has the size of `cell_size`."""
    sizes = cell_size(latitude, longitude)[::-1]
    north, east = metres_per_degree(float(np.asarray(latitude, np.float64).mean()))
    result = []
    for axis, size, degree in zip((latitude, longitude), sizes, (north, east), strict=True):
        axis = np.asarray(axis, np.float64)
        half = 0.5 * size / degree
        result.append(axis[0] + np.array([-half, half]) if axis.size == 1 else edges(axis))
    return result[0], result[1]


def turned(longitude: ArrayLike, middle: float) -> NDArray[np.float64]:
    """Wrap longitudes (degrees east) to within 180 degrees of `middle`; unwrapped values keep their bits.

    A run across the antimeridian counts beyond 180 degrees, but coordinates given to it may not.
    """
    longitude = np.asarray(longitude, np.float64)
    return longitude - 360.0 * np.round((longitude - middle) / 360.0)


def spacing(latitude: ArrayLike, longitude: ArrayLike, at: float | None = None) -> tuple[float, float]:
    """Compute the mean cell width and height (m) at the parallel `at`, by default at the grid's centre.

    An axis with a single value has no cell width: 0.
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
    """Compute cell width and height (m) for a mesh: `spacing` if an axis has at least two values.

    An axis with a single value takes the size of the other axis. A single cell takes the cell size of the
    coarser grid `within` (latitude, longitude) that contains it, else 100 m.
    """
    width, height = spacing(latitude, longitude, at)
    if within is not None and width == height == 0.0:
        width, height = spacing(*within, at)
    return width or height or _ALONE, height or width or _ALONE


def bounds(
    latitude: ArrayLike, longitude: ArrayLike, marked: NDArray[np.bool_]
) -> tuple[float, float, tuple[float, float]]:
    """Return latitude and longitude (degrees) of the middle of marked cells, and their width and height (m).

    Parameters
    ----------
    latitude, longitude
        Centres of the cells, (ny,) and (nx,), degrees.
    marked
        Marked cells (ny, nx); all of them if none is marked.
    """
    if not marked.any():
        marked = np.ones_like(marked)
    rows, columns = (np.flatnonzero(marked.any(axis))[[0, -1]] for axis in (1, 0))
    ends = np.asarray(latitude, np.float64)[rows], np.asarray(longitude, np.float64)[columns]
    middle = [float(each.mean()) for each in ends]
    tall, wide = (
        abs(float(np.diff(each)[0])) * m for each, m in zip(ends, metres_per_degree(middle[0]), strict=True)
    )
    return middle[0], middle[1], (wide, tall)
