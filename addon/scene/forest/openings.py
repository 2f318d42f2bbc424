"""How a stand is uneven: its ragged edges, its gaps, trees alone beyond it, and patches of trees alike.

A fuel cell says how much grows in it, not where. Sierra forests of mixed conifers are clumps and openings
(Larson and Churchill 2012, Forest Ecology and Management 267:74-92), and end in ragged edges with single
trees beyond them; sizes and shares here are chosen by eye. Edges stand on average where the cells' do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...shot import noise
from ...shot.ground import bilinear, box, widened
from ...shot.shot import Shot

LONE_FUEL = 0.02  # kg/m2; stands for the trees of cells without canopy fuel: 57 stems a hectare, up to 15 m
_SEED = 6  # cells; so far from others trees stand alone
_LONE = 0.5  # part of these that is there in their clumps
_EDGE, _RAGGED = 38.0, 0.6  # m, size of an edge's bays; how far they reach, cells
_GAP, _OPEN = 62.0, 0.88  # m, size of gaps; part of their trees that is missing

Array = NDArray[np.float64]


def with_lone(
    shot: Shot, fuel: NDArray, row: Array, column: Array, where: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """Canopy fuel (fy, fx) of cells at rows (fy,) and columns (fx,) of the ground, with that of lone trees.

    They stand within `_SEED` cells of others, and not in lakes or where the fuel is unknown; known they are
    in the chosen cells (fy, fx) and the ones beside these.
    """
    fuel = fuel.astype(np.float32)
    inside = box(where, more=1 + _SEED)
    if inside is None:
        return fuel
    part = fuel[inside]
    lines = (np.round(at[along]).astype(int) for at, along in zip((row, column), inside, strict=True))
    dry = shot.ground.water[np.ix_(*lines)] < 0.5
    near = widened(part > LONE_FUEL, _SEED)
    part[(part <= LONE_FUEL) & dry & near] = LONE_FUEL
    return fuel


def kept(shot: Shot, position: Array) -> Array:
    """Part (n,) 0..1 of the stems at places (n, 3) that stand."""
    ground, seed = shot.ground, shot.settings.seed
    x, y = position[:, 0], position[:, 1]
    row, column = ground.under(position)
    empty = bilinear((ground.fields.canopy_fuel <= LONE_FUEL).astype(np.float64), row, column)
    wet = bilinear(ground.water, row, column)
    bays = noise.fractal(x, y, _EDGE, 2, seed + 410)
    gaps = noise.fractal(x, y, _GAP, 2, seed + 420)
    stand = noise.smoothstep(0.70, 0.30, empty + _RAGGED * bays)
    stand = stand * (1.0 - _OPEN * noise.smoothstep(0.38, 0.60, gaps))
    lone = _LONE * noise.smoothstep(-0.1, 0.5, bays) * (empty > 0.0)
    return np.maximum(stand, lone) * (wet < 0.3)


def alike(position: Array, size: float, chance: Array, seed: int) -> Array:
    """Numbers (n,) spread over 0..1 about as evenly as `chance` (n,), but alike in patches of `size` m."""
    patch = noise.fractal(position[:, 0], position[:, 1], size, 2, seed) / 0.4
    own = np.log(np.maximum(chance, 1.0e-6) / np.maximum(1.0 - chance, 1.0e-6))
    return 1.0 / (1.0 + np.exp(-0.8 * 1.702 * patch - 0.6 * own))
