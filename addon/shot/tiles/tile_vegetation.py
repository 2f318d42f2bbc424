"""Whose trees stand where 3-D Tiles show: those of the tiles, or the scene's on ground cleared for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..shot import Shot, cached_on_shot
from ..terrain.terrain import widened
from . import tile_cut

if TYPE_CHECKING:
    from ..terrain.tile_heights import TileHeights

OURS, BURNED = "ours", "ours where it burns"
"""Values of `tiles.trees`, beside "theirs"."""
AROUND = 100.0
"""m around the burned area that counts to it."""

Array = NDArray[np.float64]


def are_ours(shot: Shot, position: Array) -> NDArray[np.bool_]:
    """Whether trees at places (n, 2 or 3), scene metres, are the scene's where tiles show growth."""
    trees = shot.settings.tiles.trees
    if trees != BURNED:
        return np.full(len(position), trees == OURS)
    ground = shot.ground
    row, column = ground.indices(*ground.geodetic(position[:, 0], position[:, 1]))
    return _burned(shot)[np.round(row).astype(int), np.round(column).astype(int)]


def may_stand(shot: Shot, position: Array, tiles: TileHeights | None = None) -> NDArray[np.bool_]:
    """Whether plants of the scene may stand at places (n, 2 or 3), m: not in the tiles' forest or buildings.

    Parameters
    ----------
    tiles
        Surface of the tiles; None: that of the shot.
    """
    tiles = tiles or tile_cut.heights(shot)
    if tiles is None or not len(position):
        return np.ones(len(position), bool)
    east, north = position[:, 0], position[:, 1]
    may = ~np.isfinite(tiles.up(east, north))
    here = np.flatnonzero(~may)
    may[here] = are_ours(shot, position[here]) & ~tiles.building(east[here], north[here])
    return may


@cached_on_shot
def _burned(shot: Shot) -> NDArray[np.bool_]:
    """Burned area of the run with its margin, on the terrain grid."""
    reach = int(np.ceil(AROUND / min(shot.ground.cell)))
    return widened(shot.ground.burned > 0.0, reach)
