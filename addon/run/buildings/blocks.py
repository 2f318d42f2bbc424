"""Mesh of buildings: walls and level roofs as triangles with separate corners."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from . import rings
from .placement import Building
from .rings import Array, Rings


def block(
    building: Building, triangles: Callable[[Rings], Array] = rings.triangles
) -> tuple[Array, NDArray[np.bool_]]:
    """Build the triangles of a building, anticlockwise seen from outside.

    Parameters
    ----------
    triangles
        Function that triangulates the rings of a polygon: (t, 3, 2), anticlockwise.

    Returns
    -------
    Corners (t, 3, 3): east and north in units of the footprint, and height, m; and a mask of roofs (t,).
    """
    walls = [_walls(ring, building.base, building.roof) for ring in building.footprint.rings]
    flat = triangles(building.footprint.rings)
    roof = np.concatenate([flat, np.full((*flat.shape[:2], 1), building.roof)], axis=2)
    count = sum(len(each) for each in walls)
    return np.concatenate([*walls, roof]), np.arange(count + len(roof)) >= count


def _walls(ring: Array, base: float, roof: float) -> Array:
    """Build two triangles for each side of a ring: (2 n, 3, 3)."""
    following = np.roll(ring, -1, axis=0)
    low, high = np.full(len(ring), base), np.full(len(ring), roof)
    first, second = np.column_stack([ring, low]), np.column_stack([following, low])
    third, fourth = np.column_stack([following, high]), np.column_stack([ring, high])
    return np.stack([first, second, third, first, third, fourth], axis=1).reshape(-1, 3, 3)
