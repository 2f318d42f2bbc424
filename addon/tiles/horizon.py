"""Horizon culling of tiles that are behind the Earth for all eyes of a shot.

Coordinates are divided by the axes of the ellipsoid, which becomes the unit sphere (Cozzi and Ring, 3D Engine
Design for Virtual Globes, 2011, 2.4 and 12.2.3). Hidden points are beyond the plane of the eye's horizon and
within the cone that touches the sphere. A sphere is hidden if all of its points are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import E2, A

LOWEST = 1000.0  # m below WGS84: all ground is higher (Dead Sea: -430 m)
_AXES = np.array([A, A, A * np.sqrt(1.0 - E2)]) - LOWEST

Array = NDArray[np.float64]


def hidden_mask(centre: Array, radius: Array, eyes: Array) -> NDArray[np.bool_]:
    """Test whether spheres (n,) are behind the Earth for all eyes; none without an eye.

    Parameters
    ----------
    centre, radius
        (n, 3) and (n,) Earth-centred, m.
    eyes
        (k, 3) Earth-centred, m. For an eye below the ground nothing is hidden.
    """
    result = np.full(len(centre), len(eyes) > 0)
    place, size = centre / _AXES, radius / _AXES.min()
    for eye in eyes / _AXES:
        left = np.flatnonzero(result)
        if len(left) == 0:
            break
        result[left] = _is_behind(place[left], size[left], eye)
    return result


def _is_behind(place: Array, radius: Array, eye: Array) -> NDArray[np.bool_]:
    """Test whether scaled spheres are behind the unit sphere for one scaled eye."""
    away = float(np.linalg.norm(eye))
    if away <= 1.0:
        return np.zeros(len(place), bool)
    axis = eye / away
    along = place @ axis
    across = np.linalg.norm(place - along[:, None] * axis, axis=1)
    sine, cosine = 1.0 / away, np.sqrt(1.0 - 1.0 / away**2)
    inside = (away - along) * sine - across * cosine  # distance from the cone, within it
    return (along + radius <= sine) & (inside >= radius)
