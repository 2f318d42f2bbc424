"""Flames at places of the ground at one time: full length, distance behind the front, and low flames.

Needs no Blender.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from firetwin_core import constants
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...geometry import grids
from ..terrain import noise
from . import flame_noise, flame_phase, flame_size

FARTHEST = 9000.0  # m, bound of the distance from the front
LEAST, LONGEST = 0.15, 75.0  # m, flame lengths
_CROWN_SURGE = 0.5  # part of the surges that a crown fire does not have: they would be columns (by eye)
_TALL = 1.2  # length of tall flames over the mean length, without surges (by eye)
TALLEST = _TALL * flame_noise.MOST_SURGE  # length of the longest flames over the mean length
RAGGED = 14.0, 2.5  # m, size and shift of the ragged edge of a crown fire's front (by eye)
_BETWEEN = 0.8  # length between clumps of crowns over the length in them (by eye)
_LEAST_FUEL = 0.05  # kg/m2
_EDGE = 0.2  # margin to gaps over which flames become shorter; narrower edges would comb them (by eye)
_BLURS = 16  # most passes that smooth the mean length
_HELD = 0.5, 0.4  # width over which flames end at the perimeter: flame lengths; at most, cells (by eye)

_TURN = (0.35, 0.5, 30.0)
"""Steps each way for the front's pace and direction: in flame lengths; at least, and at most, m."""
_STEEP = 3.0  # greatest factor between the front's pace at a place and over a cell
_AHEAD = 8.0  # flame lengths ahead of the front, up to which flames can lean or their distance be wrong

_PATCH = 9.0  # m, size of patches of fuel that burn on behind the front

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FlameState:
    """Flames at n places.

    Attributes
    ----------
    length
        Full length of flames when the front is there, m; 0 in gaps and where nothing burns.
    scale
        Mean length of the flames around, m, to which the patterns in flames are drawn.
    distance
        Distance behind the front, m; negative ahead of it.
    low
        Height now of flames that burn on behind the front, m.
    direction
        (n, 2) unit vectors to the east and north in which the front moves; 0 where no flames are near.
    """

    length: Array
    scale: Array
    distance: Array
    low: Array
    direction: Array


def at(
    shot: Any, place: Array, row: Array, column: Array, time: float, wind: tuple[float, float]
) -> FlameState:
    """Return the flames at scene points (n, 2), m, with their row and column, at a time (s).

    Flames end within half a flame length beyond the final perimeter, not at a wall. The length of a solved
    front does not depend on age: the front itself grows and declines across.

    Parameters
    ----------
    wind
        Wind to the east and north that carries the gas of flames, m/s.
    """
    ground, front = shot.ground, shot.full.front
    unshifted = row, column
    row, column = shift(shot, place, row, column)
    speed, residence = ground.spread(row, column), bilinear(front.residence, row, column)
    even = even_length(shot, row, column)
    scale = np.minimum(even * patchiness(shot, place, even), LONGEST)
    length = scale * _held(ground, row, column, even) * tongues(shot, place, even)
    length = np.where(length >= LEAST, np.minimum(length, LONGEST), 0.0)
    age = time - bilinear(ground.burn_time, row, column)
    distance, direction = _front(shot, place, *unshifted, age, speed, scale)
    low = np.zeros(len(length))
    behind = np.flatnonzero((length > 0.0) & flame_phase.is_behind(distance, length))
    if len(behind):
        share = flame_phase.low(
            age[behind],
            distance[behind],
            speed[behind],
            residence[behind],
            length[behind],
            patches(shot, place[behind]),
        )
        long = length[behind] * share
        low[behind] = long * flame_noise.upright(long, wind)
    low = np.where(low >= LEAST, low, 0.0)
    return FlameState(length, scale, distance, low, direction)


def _front(
    shot: Any, place: Array, row: Array, column: Array, age: Array, speed: Array, scale: Array
) -> tuple[Array, Array]:
    """Return distance behind the front (n,), m, and its direction (n, 2), from one slope of arrival times.

    Solved flames are drawn along and across the front: they are sheared where both disagree.
    """
    distance, direction = age * speed, np.zeros((len(age), 2))
    near = np.flatnonzero((scale > 0.0) & (distance > -_AHEAD * scale))
    if len(near):
        step = np.clip(_TURN[0] * scale[near], *_TURN[1:])
        slope = _slope(shot, place[near], row[near], column[near], step)
        pace = np.hypot(*slope.T)
        direction[near] = slope / np.maximum(pace, 1.0e-9)[:, None]
        distance[near] = age[near] / np.clip(pace, 1.0 / (_STEEP * speed[near]), _STEEP / speed[near])
    return np.clip(distance, -FARTHEST, FARTHEST), direction


def _slope(shot: Any, place: Array, row: Array, column: Array, step: Array) -> Array:
    """Return the slope (n, 2) of arrival times to the east and north, s/m, over steps (n,), m, each way."""
    ground, slope = shot.ground, []
    for axis in (1, 0):
        rise = np.zeros(len(step))
        for sign in (1.0, -1.0):
            moved, at = place.copy(), [row, column]
            moved[:, 1 - axis] += sign * step
            at[axis] = at[axis] + sign * step / ground.cell[axis]
            rise += sign * bilinear(ground.burn_time, *shift(shot, moved, *at))
        slope.append(rise / (2.0 * step))
    return np.stack(slope, axis=-1)


def shift(shot: Any, place: Array, row: Array, column: Array) -> tuple[Array, Array]:
    """Return rows and columns (n,) with shifts that make the front's edge ragged."""
    cell, scale, seed = shot.ground.cell, pattern_scale(shot), shot.full.settings.seed
    east, north = place.T
    size, far = (scale * each for each in RAGGED)
    up, right = (
        noise.fractal(east, north, size, 1, seed + 540 + axis) * (far / cell[axis]) for axis in range(2)
    )
    return row + up, column + right


def pattern_scale(shot: Any) -> float:
    """Return the size of patterns along the front relative to a crown fire's."""
    return float(max(shot.full.front_scale, 0.3))


def even_length(shot: Any, row: Array, column: Array) -> Array:
    """Return the mean flame length (n,), m, at rows and columns; 0 without fuel."""
    fields = shot.ground.fields
    fuel = bilinear(fields.canopy_fuel, row, column) + bilinear(fields.surface_fuel, row, column)
    return bilinear(shot.full.flame_length, row, column) * (fuel > _LEAST_FUEL)


def mean_length(shot: Any) -> Array:
    """Return the mean flame length (ny, nx), m, on the terrain grid, continued into cells that do not burn.

    It is smoothed over half a tall flame: lengths vary over the length of a flame, not from cell to cell.
    """
    ground, front = shot.full.bare_ground, shot.full.front
    canopy = ground.fields.canopy_fuel
    fuel = np.where(ground.burned > 0.0, canopy + ground.fields.surface_fuel, 0.0)
    intensity = constants.HEAT_OF_COMBUSTION / 1000.0 * fuel * front.speed
    length = flame_size.flame_length(
        intensity, shot.full.settings.fire.flame_length, canopy > flame_size.CROWNS
    )
    burns = fuel > _LEAST_FUEL
    if not burns.any():
        return np.zeros(length.shape)
    cells = np.percentile(length[burns], 90.0) / sum(ground.cell)
    passes = int(np.clip(np.ceil(2.0 * cells**2), 1, _BLURS))  # each adds a variance of half a cell squared
    layers = np.stack([np.where(burns, np.log(np.maximum(length, LEAST)), 0.0), burns], axis=-1)
    for _ in range(passes):
        layers = grids.blur(layers)
    weight = layers[..., 1]
    return np.where(weight > 0.0, np.exp(layers[..., 0] / np.maximum(weight, 1.0e-9)), 0.0)


def patchiness(shot: Any, place: Array, even: Array) -> Array:
    """Return a factor (n,) on mean flame lengths (m) at scene points (n, 2), m: patches flare up or creep."""
    east, north = place.T
    crowded, factor = noise.smoothstep(*flame_noise.EVEN, even), np.ones(len(even))
    flaring, crowns = np.flatnonzero(crowded < 1.0), np.flatnonzero(crowded > 0.0)
    factor[flaring] = flame_noise.flare_factor(
        east[flaring], north[flaring], even[flaring], pattern_scale(shot), shot.full.settings.seed
    )
    clumps = flame_noise.clumping(shot, east[crowns], north[crowns])
    sparse = (1.0 - _BETWEEN) * (1.0 - noise.smoothstep(*flame_noise.CLUMPS, clumps))
    factor[crowns] *= 1.0 - crowded[crowns] * sparse
    return np.minimum(factor, _TALL)


def tongues(shot: Any, place: Array, even: Array) -> Array:
    """Return a factor (n,) on flame lengths (m) at scene points (n, 2), m: tongues; 0 in gaps of a front."""
    east, north = place.T
    seed, crowded = shot.full.settings.seed, noise.smoothstep(*flame_noise.EVEN, even)
    factor = flame_noise.surge_factor(east, north, even, seed) ** (1.0 - _CROWN_SURGE * crowded)
    broken = np.flatnonzero(flame_noise.gap_fraction(even) > 0.0)
    margin = flame_noise.gap_margin(east[broken], north[broken], even[broken], pattern_scale(shot), seed)
    factor[broken] *= noise.smoothstep(-_EDGE, _EDGE, margin)
    return factor


def patches(shot: Any, place: Array) -> Array:
    """Return noise (n,) at scene points (n, 2), m. Fuel burns on behind the front where it is high."""
    east, north = place.T
    wave = noise.fractal(east, north, _PATCH * pattern_scale(shot), 2, shot.full.settings.seed + 560)
    return wave + flame_noise.clumping(shot, east, north)


def _held(ground: Any, row: Array, column: Array, length: Array) -> Array:
    """Return the weight (n,) of flames near the final perimeter: 1 inside, 0 half a flame length outside."""
    cell = 0.5 * sum(ground.cell)
    width = np.minimum(_HELD[0] * length / cell, _HELD[1])
    inside = bilinear(ground.burned, row, column) - 0.5
    return noise.smoothstep(0.0, 1.0, 1.0 + inside / np.maximum(width, 1.0e-3))
