"""Shapes of live trees: models of the film with few triangles nearby, two crossed sheets far away.

Sheets have the outline of a crown, so they need neither a picture nor transparency.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..forest import models
from ..forest.shape import FOLIAGE

_LEVEL = 3  # of the film's levels of detail
_CORNERS = 1.15  # width of sheets over the crown's, which has gaps
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Crown:
    """Shape of a tree a metre tall.

    Attributes
    ----------
    points, triangles
        (n, 3) m, (m, 3) indices.
    colours
        (n, 3) linear reflectance.
    leaf
        (n,) 1 on leaves, 0 on wood.
    outward
        (n, 3) normals that make it look round.
    """

    points: Array
    triangles: NDArray[np.int64]
    colours: Array
    leaf: Array
    outward: Array


@functools.cache
def near(model: int) -> Crown:
    """Return a tree of a few dozen triangles."""
    points, triangles, materials, colours = models.every()[model].make(_LEVEL).mesh()
    leaf = np.zeros(len(points))
    leaf[triangles[materials == FOLIAGE]] = 1.0
    return Crown(points, triangles, colours, leaf, _outward(points))


@functools.cache
def far(model: int) -> Crown:
    """Return two crossed sheets of two triangles."""
    whole = near(model)
    leaves = whole.leaf > 0.5
    if not leaves.any():
        return _sheets(0.0, float(whole.points[:, 2].max()), 0.5, 0.02, whole.colours.mean(axis=0), 0.0)
    points = whole.points[leaves]
    up, across = points[:, 2], np.hypot(points[:, 0], points[:, 1])
    low, high = float(up.min()), float(up.max())
    conifer = up.std() > points[:, 0].std()
    return _sheets(
        low,
        high,
        low + (0.25 if conifer else 0.5) * (high - low),
        _CORNERS * float(np.percentile(across, 85)),
        whole.colours[leaves].mean(axis=0),
        1.0,
    )


def _sheets(low: float, high: float, middle: float, wide: float, colour: Array, leaf: float) -> Crown:
    points = np.array(
        [
            (0, 0, low),
            (0, 0, high),
            (wide, 0, middle),
            (-wide, 0, middle),
            (0, wide, middle),
            (0, -wide, middle),
        ]
    )
    triangles = np.array([(0, 2, 1), (0, 1, 3), (0, 4, 1), (0, 1, 5)])
    return Crown(points, triangles, np.tile(colour, (6, 1)), np.full(6, leaf), _outward(points))


def _outward(points: Array) -> Array:
    """Return normals away from the trunk, and upwards (n, 3)."""
    way = points * (1.0, 1.0, 0.0)
    way = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1.0e-6)
    way[:, 2] = 0.35 + 0.5 * points[:, 2]
    return way / np.linalg.norm(way, axis=1, keepdims=True)
