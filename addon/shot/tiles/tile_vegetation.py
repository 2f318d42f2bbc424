"""Vegetation where 3D Tiles are shown: of the tileset, or of the scene on flattened tiles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ..shot import Shot, cached_on_shot
from . import tile_cut

if TYPE_CHECKING:
    from ..terrain.tile_heights import TileHeights

MARGIN = 100.0
"""m around the burned area that counts as burned."""

Array = NDArray[np.float64]


def is_of_scene(shot: Shot, position: Array) -> NDArray[np.bool_]:
    """Test whether the scene, not the tileset, has the vegetation at places (n, 2 or 3), scene metres."""
    vegetation = shot.settings.tiles.vegetation
    if vegetation != "scene_near_burn":
        return np.full(len(position), vegetation == "scene")
    ground = shot.ground
    row, column = ground.indices(*ground.geodetic(position[:, 0], position[:, 1]))
    return _burned(shot)[np.round(row).astype(int), np.round(column).astype(int)]


def may_grow(shot: Shot, position: Array, tiles: TileHeights | None = None) -> NDArray[np.bool_]:
    """Test whether plants of the scene may grow at places (n, 2 or 3), m: not in tiles' trees or buildings.

    Parameters
    ----------
    tiles
        Surface of the tiles; None: of the shot's tiles.
    """
    tiles = tiles or tile_cut.heights(shot)
    if tiles is None or not len(position):
        return np.ones(len(position), bool)
    east, north = position[:, 0], position[:, 1]
    may = ~np.isfinite(tiles.up(east, north))
    here = np.flatnonzero(~may)
    may[here] = is_of_scene(shot, position[here]) & ~tiles.building(east[here], north[here])
    return may


@cached_on_shot
def _burned(shot: Shot) -> NDArray[np.bool_]:
    """Mask of the burned area of the run with its margin, on the terrain grid."""
    reach = int(np.ceil(MARGIN / min(shot.ground.cell)))
    return dilate(shot.ground.burned > 0.0, reach)
