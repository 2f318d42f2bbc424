"""Algorithm 2 in vectorised NumPy: what someone would write without firetwin_core.

Its random numbers are numpy.random.Philox's, drawn in one stream for speed, so it grows another forest of
the same kind; a forest that does not depend on order, as firetwin_core's, would cost it several times more.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SEMI_MAJOR, FLATTENING = 6378137.0, 1 / 298.257223563
ECCENTRICITY2 = FLATTENING * (2 - FLATTENING)


@dataclass
class Plants:
    cell: NDArray[np.int64]
    position: NDArray[np.float64]
    scale: NDArray[np.float32]
    rotation: NDArray[np.float32]
    size_class: NDArray[np.uint8] | None = None
    model: NDArray[np.uint8] | None = None


def to_local(latitude, longitude, height, origin) -> NDArray[np.float64]:
    """WGS84 degrees and metres -> (n, 3) east, north, up in metres about an origin."""

    def polar(latitude, height):
        sine, cosine = np.sin(latitude), np.cos(latitude)
        normal = SEMI_MAJOR / np.sqrt(1 - ECCENTRICITY2 * sine * sine)
        return (normal + height) * cosine, (normal * (1 - ECCENTRICITY2) + height) * sine

    latitude0 = np.radians(origin[0])
    r0, z0 = polar(latitude0, origin[2])
    r, z = polar(np.radians(latitude), height)
    turn = np.radians(longitude - origin[1])
    dr, dz = r * np.cos(turn) - r0, z - z0
    sine, cosine = np.sin(latitude0), np.cos(latitude0)
    return np.stack([r * np.sin(turn), cosine * dz - sine * dr, sine * dz + cosine * dr], axis=1)


def place(cell, latitude, longitude, elevation, origin, rng) -> NDArray[np.float64]:
    """Jittered places (n, 3) on the bilinear elevation of an even grid (degrees), metres."""
    rows, columns = elevation.shape
    y = np.clip(cell // columns + rng.random(len(cell)) - 0.5, 0, rows - 1)
    x = np.clip(cell % columns + rng.random(len(cell)) - 0.5, 0, columns - 1)
    j, i = np.minimum(y.astype(np.intp), rows - 2), np.minimum(x.astype(np.intp), columns - 2)
    v, u = y - j, x - i
    corner = j * columns + i
    h = elevation.ravel()
    low = h[corner] * (1 - u) + h[corner + 1] * u
    high = h[corner + columns] * (1 - u) + h[corner + columns + 1] * u
    north = latitude[0] + y * (latitude[1] - latitude[0])
    east = longitude[0] + x * (longitude[1] - longitude[0])
    return to_local(north, east, low * (1 - v) + high * v, origin)


def trees(canopy, latitude, longitude, elevation, origin, seed=0) -> Plants:
    """Algorithm 2's trees from canopy fuel (fy, fx) kg/m2."""
    rng = np.random.Generator(np.random.Philox(seed))
    cell = np.flatnonzero(canopy > 0.01)
    fuel = canopy.ravel()[cell].astype(float)
    size_class = (fuel >= 0.8).astype(np.uint8) + (fuel >= 1.6)
    low = np.array([0.7, 0.9, 1.1])[size_class]
    models = np.array([4, 4, 2])[size_class]
    random = rng.random((4, len(cell)))
    height = (6 + 12 * np.minimum(fuel / canopy.max(), 1)) * (low + 0.3 * random[0]) * (0.8 + 0.4 * random[1])
    return Plants(
        cell,
        place(cell, latitude, longitude, elevation, origin, rng),
        height.astype(np.float32),
        (2 * np.pi * random[3]).astype(np.float32),
        size_class,
        (random[2] * models).astype(np.uint8),
    )


def grass(surface, latitude, longitude, elevation, origin, seed=0) -> Plants:
    """Algorithm 2's grass from surface fuel (fy, fx) kg/m2."""
    rng = np.random.Generator(np.random.Philox(seed))
    cell = np.flatnonzero(surface > 0)
    position = place(cell, latitude, longitude, elevation, origin, rng)
    position[:, 2] -= 0.70
    rotation = (2 * np.pi * rng.random(len(cell))).astype(np.float32)
    return Plants(cell, position, np.ones(len(cell), np.float32), rotation)
