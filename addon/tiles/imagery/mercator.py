"""Quadtree of square tiles of Web Mercator.

Tiles: matrix set WebMercatorQuad of OGC 17-083r4, "Two Dimensional Tile Matrix Set".
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...ellipsoid import A, metres_per_degree
from ...geometry.mercator import forward, inverse

HALF = math.pi * A
"""m, half the side of the map's square: 20,037,508.34 m."""
NORTHMOST = math.degrees(math.atan(math.sinh(math.pi)))
"""Latitude of the square's upper edge, degrees: 85.05."""
DENOMINATOR = 559_082_264.028_717_8
"""Scale denominator of level 0 with tiles of 256 pixels of 0.28 mm."""
DEEPEST = 30  # level: beyond, columns do not fit 32 bits

Array = NDArray[np.float64]


def tile_at(latitude: ArrayLike, longitude: ArrayLike, level: int) -> tuple[Array, Array]:
    """Compute fractional columns and rows of places in tiles; rows count from the north.

    Longitudes beyond 180 degrees give columns below 0 or from 2^level on.
    """
    east, north = forward(latitude, longitude)
    scale = 2.0**level / (2.0 * HALF)
    return (east + HALF) * scale, (HALF - north) * scale


def place_of(column: ArrayLike, row: ArrayLike, level: int) -> tuple[Array, Array]:
    """Compute latitude and longitude, degrees: the inverse of `tile_at`."""
    scale = 2.0 * HALF / 2.0**level
    return inverse(np.asarray(column) * scale - HALF, HALF - np.asarray(row) * scale)


def texel(latitude: float, level: int, side: int) -> float:
    """Compute the size of a texel on the ground, m, in tiles of `side` pixels.

    The result is the width on the WGS84 ellipsoid; the height is up to 0.7 % smaller.
    """
    return metres_per_degree(latitude)[1] * 360.0 / (side * 2.0**level)


def level_for(step: float, latitude: float, side: int) -> int:
    """Find the coarsest level with texels of at most `step` metres at a latitude."""
    return int(np.clip(math.ceil(math.log2(texel(latitude, 0, side) / step) - 1.0e-9), 0, DEEPEST))
