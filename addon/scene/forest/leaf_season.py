"""Leaves of tree models by season: turned, or fallen so that only twigs remain. Without Blender."""

from __future__ import annotations

import numpy as np

from .phenology import LeafState
from .shape import FOLIAGE, Array, Colour, Shape

_TWIG: Colour = (0.074, 0.061, 0.050)  # twigs of bare crowns, by eye
_BARE = 0.55  # fraction of the leaves that stand for twigs in a bare crown, by eye
_THIN = 0.35  # width of twigs in widths of the leaves, by eye
_GOLDEN = 0.618034


def dressed(shape: Shape, summer: Colour, autumn: Colour, state: LeafState) -> Shape:
    """Colour and thin the leaves of a deciduous model for the season.

    Parameters
    ----------
    summer, autumn
        Reflectance of the species' leaves when they are green, and when they have turned.
    """
    if state == LeafState():
        return shape
    result = Shape()
    for points, triangles, materials, colours in zip(
        shape.points, shape.triangles, shape.materials, shape.colours, strict=True
    ):
        if not len(materials) or materials[0] != FOLIAGE:
            result.add(points, triangles - triangles.min(initial=0), int(materials[0]), colours)
            continue
        _add(result, points.reshape(-1, 3, 3), colours.reshape(-1, 3, 3), (summer, autumn), state)
    return result


def _add(
    shape: Shape, corners: Array, colours: Array, palette: tuple[Colour, Colour], state: LeafState
) -> None:
    """Add leaves (n, 3, 3) in their colour of the season; each turns and falls at its own time."""
    summer, autumn = (np.array(colour) for colour in palette)
    lot = (np.arange(len(corners)) * _GOLDEN) % 1.0
    late = (lot * 7.0) % 1.0
    turned = np.clip(1.6 * state.turned - 0.6 * late, 0.0, 1.0)[:, None, None]
    leaf = colours * (1.0 + turned * (autumn / summer - 1.0))
    fallen = lot < state.fallen
    kept = ~fallen | (lot < _BARE * state.fallen)
    bright = colours.mean(axis=-1, keepdims=True) / summer.mean()
    leaf = np.where(fallen[:, None, None], np.array(_TWIG) * bright, leaf)
    middle = corners.mean(axis=1, keepdims=True)
    along = corners[:, :1] - middle  # from the centre to the leaf's base
    length = np.maximum(np.sum(along * along, axis=-1, keepdims=True), 1.0e-12)
    off = corners - middle
    lengthwise = along * (np.sum(off * along, axis=-1, keepdims=True) / length)
    thin = middle + lengthwise + _THIN * (off - lengthwise)
    corners = np.where(fallen[:, None, None], thin, corners)
    shape.leaves(corners[kept], leaf[kept, 0])
