"""Skirts: walls from the border of the tiles down into the adjacent ground, which hide gaps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...shot.shot import Shot
from ...shot.tiles import tile_cut
from ...tiles.decoded import Decoded

_BELOW = 2.0  # m, depth of a skirt below the adjacent ground


def add_skirt(shot: Shot, tile: Decoded) -> Decoded:
    """Add walls below a tile's open edges at the border of all tiles."""
    heights = tile_cut.heights(shot)
    if heights is None or not len(tile.triangle):
        return tile
    place = tile.position.astype(np.float64) + tile.origin
    outer = heights.rim(place[:, 0], place[:, 1])
    if not outer.any():
        return tile
    edge, owner = open_edges(tile.triangle)
    chosen = outer[edge].all(axis=1)
    if not chosen.any():
        return tile
    edge, owner = edge[chosen], owner[chosen]
    top, number = np.unique(edge, return_inverse=True)
    foot = tile.position[top].copy()
    ground = shot.ground.up(place[top, 0], place[top, 1])
    foot[:, 2] = np.minimum(place[top, 2], ground) - _BELOW - tile.origin[2]
    low = (len(place) + number.reshape(-1, 2)).astype(np.int32)
    a, b = edge.T
    walls = np.vstack([np.column_stack([b, a, low[:, 0]]), np.column_stack([b, low[:, 0], low[:, 1]])])
    return replace(
        tile,
        position=np.vstack([tile.position, foot]),
        normal=np.vstack([tile.normal, tile.normal[top]]),
        uv=np.vstack([tile.uv, tile.uv[top]]),
        colour=np.vstack([tile.colour, tile.colour[top]]) if len(tile.colour) else tile.colour,
        triangle=np.vstack([tile.triangle, walls]).astype(np.int32),
        material_index=np.concatenate([tile.material_index, *2 * [tile.material_index[owner]]]),
    )


def open_edges(triangle: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Find edges (e, 2) of only one triangle, in its direction, and the number of this triangle."""
    edge = triangle[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    low, high = edge.min(axis=1).astype(np.int64), edge.max(axis=1)
    _, first, count = np.unique(low << 32 | high, return_index=True, return_counts=True)
    alone = first[count == 1]
    return edge[alone], alone // 3
