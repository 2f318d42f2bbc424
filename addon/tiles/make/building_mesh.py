"""The mesh of buildings: walls and level roofs, with flat shading."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...ellipsoid import ecef
from ..buildings import Building, triangles
from .glb import Mesh

Array = NDArray[np.float64]
_COLOUR = (0.48, 0.44, 0.40, 1.0)
"""Linear base colour of walls and roofs: light grey-brown, an assumption."""


def mesh(buildings: Sequence[Building]) -> Mesh:
    """One mesh of several buildings; every face has vertices of its own."""
    corners = np.vstack([part for each in buildings for part in (*_walls(each), _roof(each))])
    longitude, latitude = np.radians(corners[:, :2]).T
    position = ecef(latitude, longitude, corners[:, 2])
    sides = position.reshape(-1, 3, 3)
    normal = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    origin = np.round(position.mean(axis=0))
    return Mesh(
        origin=origin,
        position=position - origin,
        normal=np.repeat(normal, 3, axis=0),
        triangles=np.arange(len(position)).reshape(-1, 3),
        colour=_COLOUR,
    )


def _walls(building: Building) -> list[Array]:
    """Triangles (t * 3, 3) of longitude, latitude and height along each ring."""
    found = []
    for ring in (building.outer, *building.holes):
        following = np.roll(ring, -1, axis=0)
        low, high = np.full(len(ring), building.base), np.full(len(ring), building.roof)
        first, second = np.column_stack([ring, low]), np.column_stack([following, low])
        third, fourth = np.column_stack([following, high]), np.column_stack([ring, high])
        found.append(np.stack([first, second, third, first, third, fourth], axis=1).reshape(-1, 3))
    return found


def _roof(building: Building) -> Array:
    flat = triangles(building.outer, building.holes).reshape(-1, 2)
    return np.column_stack([flat, np.full(len(flat), building.roof)])
