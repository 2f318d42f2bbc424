"""Flattening of vegetation in tiles onto the ground, where the scene plants its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...shot.shot import Shot
from ...shot.tiles import tile_cut, tile_vegetation
from ...tiles.decoded import Decoded

LEAST = 1.0
"""m above the ground from which a vertex is flattened."""


def flatten(shot: Shot, tile: Decoded) -> Decoded:
    """Move vertices of vegetation onto the ground, and recompute their normals; buildings stay."""
    heights = tile_cut.heights(shot)
    if heights is None or shot.settings.tiles.vegetation == "tileset":
        return tile
    place = tile.position.astype(np.float64) + tile.origin
    growing = np.flatnonzero(heights.growth(place[:, 0], place[:, 1]))
    ground = heights.up(place[growing, 0], place[growing, 1])
    high = place[growing, 2] - ground > LEAST
    high[high] = tile_vegetation.is_of_scene(shot, place[growing[high]])
    if not high.any():
        return tile
    moved = growing[high]
    position = tile.position.copy()
    position[moved, 2] = ground[high] - tile.origin[2]
    return replace(tile, position=position, normal=_recompute_normals(tile, position, moved))


def _recompute_normals(
    tile: Decoded, position: NDArray[np.float32], moved: NDArray[np.integer]
) -> NDArray[np.float32]:
    """Recompute normals (n, 3) of all vertices of triangles with a moved vertex.

    A normal is the area-weighted mean of the triangles' normals, or up if the mean is zero.
    """
    changed = np.zeros(len(position), bool)
    changed[moved] = True
    triangles = tile.triangle[changed[tile.triangle].any(axis=1)]
    changed[triangles] = True
    around = tile.triangle[changed[tile.triangle].any(axis=1)]
    first, second, third = (position[around[:, k]].astype(np.float64) for k in range(3))
    across = np.cross(second - first, third - first)
    across[across[:, 2] < 0.0] *= -1.0  # folded over: overhanging vegetation
    total = np.zeros((len(position), 3))
    for k in range(3):
        np.add.at(total, around[:, k], across)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    upward = np.where(length > 0.0, total / np.maximum(length, 1e-30), (0.0, 0.0, 1.0))
    return np.where(changed[:, None], upward, tile.normal).astype(np.float32)
