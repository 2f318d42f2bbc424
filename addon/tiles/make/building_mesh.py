"""Mesh of the buildings in a tile: walls and flat roofs, with flat shading."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...ellipsoid import ecef
from ...run.buildings import Building, blocks
from .glb import Mesh

_COLOUR = (0.48, 0.44, 0.40, 1.0)
"""Linear base colour of walls and roofs: light grey-brown, an assumption."""


def mesh(buildings: Sequence[Building]) -> Mesh:
    """Make one mesh of several buildings; triangles share no vertices."""
    corners = np.concatenate([blocks.block(each)[0] for each in buildings]).reshape(-1, 3)
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
