"""Stand structure: ragged edges, gaps, lone trees outside of the stand, and clumps of similar trees.

A fuel cell gives an amount, not positions. Sierra forests of mixed conifers are clumps and openings (Larson
and Churchill 2012, Forest Ecology and Management 267:74-92), and end in ragged edges with single trees beyond
them. Sizes and shares are chosen by eye. The mean position of an edge is the edge of the cells.
"""

from __future__ import annotations

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ...shot.shot import Shot
from ...shot.surface import land_use
from ...shot.terrain import noise
from ...shot.terrain.terrain import box
from ...shot.tiles import tile_vegetation
from . import biomes, cover, field_lines, planted_rows

LONE_FUEL = 0.02  # kg/m2; canopy fuel assumed for trees of cells without any: 57 stems a hectare, up to 15 m
_FULL = 0.06  # ground cover of all of these (half-grown oaks; assumed)
_GROUPED, _HOLLOW = 4.0, 1.2  # density factor in groups and hollows; by eye
_MEAN = 1.6  # offset of its logarithm that gives a mean of 1: half its variance
_ALONG, _AMID = 14.0, 0.25  # density factors of trees along hedges and draws, and in fields; by eye
_BESIDE = 0.35  # density factor of trees next to draws
_BARE = 0.5  # cover fraction of ground without fuel at which trees end
_SEED = 6  # cells; greatest distance of lone trees from others
_LONE = 0.5  # fraction of these retained in their clumps
_EDGE, _RAGGED = 38.0, 0.6  # m, wavelength of an edge's bays; their amplitude, cells
_GAP, _OPEN = 62.0, 0.88  # m, size of gaps; fraction of their trees that is missing

Array = NDArray[np.float64]


def with_lone(
    shot: Shot, fuel: NDArray, row: Array, column: Array, where: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """Canopy fuel (fy, fx) with lone trees added, of cells at rows (fy,) and columns (fx,) of the terrain.

    Lone trees stand within `_SEED` cells of others, or everywhere where the biome says so, but not in lakes
    or where the fuel is unknown. Fuel is evaluated in the chosen cells (fy, fx) and their neighbours.
    """
    fuel = fuel.astype(np.float32)
    inside = box(where, more=1 + _SEED)
    if inside is None:
        return fuel
    part = fuel[inside]
    lines = [np.round(at[along]).astype(int) for at, along in zip((row, column), inside, strict=True)]
    dry = shot.ground.water[np.ix_(*lines)] < 0.5
    if biomes.choose(shot).biome.species:
        near = shot.ground.bare[np.ix_(*lines)] < _BARE
    else:
        near = dilate(part > LONE_FUEL, _SEED)
    part[(part <= LONE_FUEL) & dry & near] = LONE_FUEL
    return fuel


def retained(shot: Shot, position: Array, planted: NDArray[np.bool_] | None = None) -> Array:
    """Probability (n,) 0..1 that stems at points (n, 3) are retained; `planted` ones have strips."""
    if planted is None:
        planted = np.zeros(len(position), bool)
    ground, seed = shot.ground, shot.settings.seed
    x, y = position[:, 0], position[:, 1]
    row, column = ground.under(position)
    empty = bilinear((ground.fields.canopy_fuel <= LONE_FUEL).astype(np.float64), row, column)
    wet = bilinear(ground.water, row, column)
    bays = noise.fractal(x, y, _EDGE, 2, seed + 410)
    gaps = noise.fractal(x, y, _GAP, 2, seed + 420)
    stand = noise.smoothstep(0.70, 0.30, empty + _RAGGED * bays)
    stand = stand * (1.0 - _OPEN * noise.smoothstep(0.38, 0.60, gaps) * ~planted)
    stand[planted] *= planted_rows.stocked(shot, position[planted])
    lone = _LONE * noise.smoothstep(-0.1, 0.5, bays) * (empty > 0.0)
    if (biome := biomes.choose(shot).biome).species:
        lone = _scattered(shot, biome.tree_cover, position) * (empty > 0.0)
    if shot.settings.terrain.land_use is not None:
        wet = np.where(land_use.keeps_out(shot, position), 1.0, wet)
    part: Array = np.maximum(stand, lone)
    return part * (wet < 0.3) * tile_vegetation.may_grow(shot, position)


def _scattered(shot: Shot, part: float, position: Array) -> Array:
    """Probability (n,) of trees of open land that gives a cover of `part`, with most trees in hollows."""
    x, y = position[:, :2].T
    groups = noise.fractal(x, y, 4.0 * _GAP, 3, shot.settings.seed + 430)
    hollow = bilinear(cover.hollows(shot.ground), *shot.ground.under(position))
    density = part / _FULL * np.exp(_GROUPED * groups + _HOLLOW * hollow - _MEAN)
    land = biomes.choose(shot).biome.open_land
    if land is not None and land.draws:
        density = density * (_BESIDE + (_ALONG - _BESIDE) * cover.draws(land, position))
    if land is not None and land.hedge > 0.0:
        off = field_lines.fields(field_lines.NUMPY, x, y, land.field)[0]
        density = np.where(off < land.hedge, _ALONG, _AMID) * density
        density[land_use.mapped(shot, position)] = 0.0
    return density


def clustered_uniform(position: Array, size: float, chance: Array, seed: int) -> Array:
    """Numbers (n,) as uniform over 0..1 as `chance` (n,), but correlated within patches of `size` m."""
    patch = noise.fractal(position[:, 0], position[:, 1], size, 2, seed) / 0.4
    own = np.log(np.maximum(chance, 1.0e-6) / np.maximum(1.0 - chance, 1.0e-6))
    return 1.0 / (1.0 + np.exp(-0.8 * 1.702 * patch - 0.6 * own))
