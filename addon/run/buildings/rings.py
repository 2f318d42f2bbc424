"""Rings of a footprint: orientation, self-intersections, triangulation and points inside."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ... import extras
from ...errors import Error
from ...geometry.polygons import area, inside

Array = NDArray[np.float64]
Rings = tuple[Array, ...]
"""Rings (n, 2), not closed: the outer one, then holes."""
_AT_ONCE = 1 << 22  # pairs of sides per array


def directed(rings: Rings) -> Rings:
    """Orient the outer ring anticlockwise and holes clockwise."""
    return tuple(ring if (area(ring) > 0.0) == (k == 0) else ring[::-1] for k, ring in enumerate(rings))


def cross(rings: Rings) -> bool:
    """Check whether any two sides cross; sides that only touch do not."""
    first = np.concatenate(rings)
    second = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    step = max(_AT_ONCE // len(first), 1)
    for start in range(0, len(first), step):
        here, there = first[start : start + step, None], second[start : start + step, None]
        apart = _side(here, there, first) * _side(here, there, second) < 0.0
        if np.any(apart & (_side(first, second, here) * _side(first, second, there) < 0.0)):
            return True
    return False


def _side(start: Array, end: Array, point: Array) -> Array:
    """Compute the side of a line on which points are: above 0 on its left."""
    along, away = end - start, point - start
    return np.asarray(np.sign(along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0]))


def mended(rings: Rings) -> tuple[list[Rings], bool] | None:
    """Split a self-intersecting polygon with GEOS; returns parts and True, or None without shapely.

    Other polygons are returned unchanged, with False. No part has zero area.
    """
    try:
        import shapely
    except ImportError:
        if cross(rings):
            return None
        return [directed(rings)] if area(rings[0]) else [], False
    shape = shapely.Polygon(rings[0], rings[1:])
    if shape.is_valid:
        return [directed(rings)], False
    whole = shapely.make_valid(shape)
    parts = [part for part in shapely.get_parts(shapely.get_parts(whole)) if part.geom_type == "Polygon"]
    found = [
        directed(tuple(np.asarray(ring.coords)[:-1] for ring in (part.exterior, *part.interiors)))
        for part in parts
        if part.area > 0.0
    ]
    return found, True


def triangles(rings: Rings) -> Array:
    """Triangulate a polygon: (t, 3, 2), anticlockwise (constrained Delaunay, by GEOS).

    Raises
    ------
    Error
        shapely is not installed.
    """
    try:
        import shapely
    except ImportError:
        reason = f"tiles of buildings need the package shapely: {extras.install('score')}"
        raise Error(reason) from None
    parts = shapely.constrained_delaunay_triangles(shapely.Polygon(rings[0], rings[1:])).geoms
    return anticlockwise(np.array([np.asarray(part.exterior.coords)[:3] for part in parts]))


def anticlockwise(corners: Array) -> Array:
    """Orient triangles (t, 3, 2) anticlockwise."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    turned = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] < 0.0
    return np.where(turned[:, None, None], corners[:, ::-1], corners)


def spread(rings: Rings, steps: Sequence[float], most: int = 32) -> Array:
    """Place points (n, 2) inside, on a lattice with at most these steps, or `most` points per side."""
    low, high = rings[0].min(axis=0), rings[0].max(axis=0)
    axes = (
        np.linspace(low[k], high[k], int(np.clip(np.ceil((high[k] - low[k]) / steps[k]), 1, most)) + 1)
        for k in (0, 1)
    )
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    return points[inside(rings, points)]


def middle(rings: Rings, within: Array) -> Array:
    """Find a point (2,) inside: the centroid of the outer ring, or the nearest of the points `within`."""
    outer = rings[0]
    start = outer[0]
    x, y = (outer - start).T
    part = x * np.roll(y, -1) - np.roll(x, -1) * y
    centroid = start + np.array([np.sum((v + np.roll(v, -1)) * part) for v in (x, y)]) / (6.0 * area(outer))
    if inside(rings, centroid[None])[0]:
        return centroid
    near = within if len(within) else outer
    return np.asarray(near[np.argmin(np.sum((near - centroid) ** 2, axis=1))])
