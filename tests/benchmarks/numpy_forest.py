"""Algorithm 2 in vectorised NumPy, as one would write it without firetwin_core.

`keyed` random numbers (Philox keyed by seed, cell and use) give the forest of firetwin_core. Numbers from
`one_stream` of numpy.random.Philox are faster and give another forest of the same statistics, in which a
changed cell changes every later tree.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

PLACE, TREE, GRASS = 0, 1, 2
A, F = 6378137.0, 1 / 298.257223563  # WGS84
Draw = Callable[[int, NDArray, int], NDArray]


def one_stream(seed: int, cell: NDArray, use: int) -> NDArray[np.float64]:
    """Draw four numbers in [0, 1) per cell (4, n), from one stream for each use."""
    return np.random.Generator(np.random.Philox(key=np.array([seed, use], np.uint64))).random((4, len(cell)))


def keyed(seed: int, cell: NDArray, use: int) -> NDArray[np.float64]:
    """Draw four numbers in [0, 1) per cell (4, n) that depend only on seed, cell and use (Philox4x64-10)."""
    half, low = np.uint64(32), np.uint64(0xFFFFFFFF)

    def product(a: int, b: NDArray) -> tuple[NDArray, NDArray]:
        a_high, a_low, b_high, b_low = np.uint64(a >> 32), np.uint64(a & 0xFFFFFFFF), b >> half, b & low
        first, second, third = a_low * b_low, a_high * b_low, a_low * b_high
        middle = (first >> half) + (second & low) + third
        return a_high * b_high + (second >> half) + (middle >> half), np.uint64(a) * b

    c0 = cell.astype(np.uint64)
    c1, c2, c3 = np.full_like(c0, use), np.zeros_like(c0), np.zeros_like(c0)
    k0, k1 = seed, 0
    for _ in range(10):
        (a_high, a_low), (b_high, b_low) = product(0xD2E7470EE14C6C93, c0), product(0xCA5A826395121157, c2)
        c0, c1, c2, c3 = b_high ^ c1 ^ np.uint64(k0), b_low, a_high ^ c3 ^ np.uint64(k1), a_low
        k0, k1 = (k0 + 0x9E3779B97F4A7C15) % 2**64, (k1 + 0xBB67AE8584CAA73B) % 2**64
    return (np.stack([c0, c1, c2, c3]) >> np.uint64(11)) * 2.0**-53


@dataclass
class Plants:
    """Columns (n,) of plants; grass has neither size class nor model."""

    cell: NDArray[np.int64]
    position: NDArray[np.float64]
    scale: NDArray[np.float32]
    rotation: NDArray[np.float32]
    size_class: NDArray[np.uint8] | None = None
    model: NDArray[np.uint8] | None = None


Origin = tuple[float, float, float]


def local(latitude: NDArray, longitude: NDArray, height: NDArray, origin: Origin) -> NDArray:
    """Convert degrees, degrees, metres (n,) to metres (n, 3) about `origin`, by the closed form."""
    e2 = F * (2 - F)

    def polar(latitude: Any, height: Any) -> tuple[Any, Any]:
        """Return the distance from the axis and the height above the equator, m."""
        sine, cosine = np.sin(latitude), np.cos(latitude)
        normal = A / np.sqrt(1 - e2 * sine * sine)
        return (normal + height) * cosine, (normal * (1 - e2) + height) * sine

    latitude0 = np.radians(origin[0])
    r0, z0 = polar(latitude0, origin[2])
    r, z = polar(np.radians(latitude), height)
    turn = np.radians(longitude - origin[1])
    dr, dz = r * np.cos(turn) - r0, z - z0
    sine, cosine = np.sin(latitude0), np.cos(latitude0)
    return np.stack([r * np.sin(turn), cosine * dz - sine * dr, sine * dz + cosine * dr], axis=-1)


def place(
    cell: NDArray,
    latitude: NDArray,
    longitude: NDArray,
    elevation: NDArray,
    origin: Origin,
    random: NDArray,
) -> NDArray[np.float64]:
    """Return jittered positions (n, 3), m, on the bilinear elevation of a regular grid (degrees)."""
    rows, columns = elevation.shape
    y, x = cell // columns + random[0] - 0.5, cell % columns + random[1] - 0.5
    inner_y, inner_x = np.clip(y, 0, rows - 1), np.clip(x, 0, columns - 1)
    j = np.minimum(inner_y.astype(np.intp), rows - 2)
    i = np.minimum(inner_x.astype(np.intp), columns - 2)
    v, u = inner_y - j, inner_x - i
    corner = j * columns + i
    h = elevation.ravel()
    low = h[corner] * (1 - u) + h[corner + 1] * u
    high = h[corner + columns] * (1 - u) + h[corner + columns + 1] * u
    north = latitude[0] + y * (latitude[1] - latitude[0])
    east = longitude[0] + x * (longitude[1] - longitude[0])
    return local(north, east, low * (1 - v) + high * v, origin)


def trees(
    canopy: NDArray,
    latitude: NDArray,
    longitude: NDArray,
    elevation: NDArray,
    origin: Origin,
    seed: int = 0,
    draw: Draw = keyed,
) -> Plants:
    """Plant the trees of Algorithm 2 from canopy fuel (fy, fx) kg/m2."""
    cell = np.flatnonzero(canopy > 0.01)
    fuel = canopy.ravel()[cell].astype(float)
    size_class = (fuel >= 0.8).astype(np.uint8) + (fuel >= 1.6)
    low = np.array([0.7, 0.9, 1.1])[size_class]
    models = np.array([4, 4, 2])[size_class]
    random = draw(seed, cell, TREE)
    height = (6 + 12 * np.minimum(fuel / canopy.max(), 1)) * (low + 0.3 * random[0]) * (0.8 + 0.4 * random[1])
    return Plants(
        cell,
        place(cell, latitude, longitude, elevation, origin, draw(seed, cell, PLACE)),
        height.astype(np.float32),
        (2 * np.pi * random[3]).astype(np.float32),
        size_class,
        (random[2] * models).astype(np.uint8),
    )


def grass(
    surface: NDArray,
    latitude: NDArray,
    longitude: NDArray,
    elevation: NDArray,
    origin: Origin,
    seed: int = 0,
    draw: Draw = keyed,
) -> Plants:
    """Plant the grass of Algorithm 2 from surface fuel (fy, fx) kg/m2."""
    cell = np.flatnonzero(surface > 0)
    position = place(cell, latitude, longitude, elevation, origin, draw(seed, cell, PLACE))
    position[:, 2] -= 0.70
    rotation = (2 * np.pi * draw(seed, cell, GRASS)[0]).astype(np.float32)
    return Plants(cell, position, np.ones(len(cell), np.float32), rotation)
