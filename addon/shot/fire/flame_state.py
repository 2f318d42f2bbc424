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

from ..terrain import noise
from . import flame_noise, flame_phase, flame_size

FARTHEST = 9000.0  # m, bound of the distance from the front
LEAST, LONGEST = 0.15, 75.0  # m, flame lengths
_CROWN_SURGE = 0.8  # part of the surges that a crown fire does not have: they would be columns (by eye)
_TALL = 1.2  # length of tall flames over the mean length, without surges (by eye)
TALLEST = _TALL * flame_noise.MOST_SURGE  # length of the longest flames over the mean length
RAGGED = ((14.0, 3.5), (4.5, 1.2))  # m, sizes and shifts of the ragged edge of a crown fire's front (by eye)
_UNEVEN = ((26.0, 0.8, 0.7), (9.0, 0.6, 0.2))
"""Sizes of the noise of the lengths' logarithm, m, and its strengths in low flames and in a crown fire, where
narrow patches would be spears (by eye)."""
_BETWEEN = 0.55  # length between clumps of crowns over the length in them (by eye)
_LEAST_FUEL = 0.05  # kg/m2
_HELD = 0.5, 0.4  # width over which flames end at the perimeter: flame lengths; at most, cells (by eye)

_PATCH = 9.0  # m, size of patches of fuel that burn on behind the front

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FlameState:
    """Flames at n places.

    Attributes
    ----------
    length
        Full length of flames when the front is there, m; 0 in gaps and where nothing burns.
    distance
        Distance behind the front, m; negative ahead of it.
    low
        Height now of flames that burn on behind the front, m.
    """

    length: Array
    distance: Array
    low: Array


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
    row, column = shift(shot, place, row, column)
    speed, residence = ground.spread(row, column), bilinear(front.residence, row, column)
    even = even_length(shot, row, column, speed)
    length = even * _held(ground, row, column, even)
    length *= unevenness(shot, place, even)
    length = np.where(length >= LEAST, np.minimum(length, LONGEST), 0.0)
    age = time - bilinear(ground.burn_time, row, column)
    distance = np.clip(age * speed, -FARTHEST, FARTHEST)
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
    return FlameState(length, distance, low)


def shift(shot: Any, place: Array, row: Array, column: Array) -> tuple[Array, Array]:
    """Return rows and columns (n,) with shifts that make the front's edge ragged."""
    cell, scale, seed = shot.ground.cell, pattern_scale(shot), shot.full.settings.seed
    east, north = place.T
    found = [row, column]
    for index, (size, far) in enumerate(RAGGED):
        for axis in range(2):
            wave = noise.fractal(east, north, size * scale, 1, seed + 540 + 4 * index + axis)
            found[axis] = found[axis] + wave * (far * scale / cell[axis])
    return found[0], found[1]


def pattern_scale(shot: Any) -> float:
    """Return the size of patterns along the front relative to a crown fire's."""
    return float(max(shot.full.front_scale, 0.3))


def even_length(shot: Any, row: Array, column: Array, speed: Array) -> Array:
    """Return the mean flame length (n,), m, at rows and columns with a rate of spread (m/s)."""
    fields = shot.ground.fields
    canopy = bilinear(fields.canopy_fuel, row, column)
    fuel = canopy + bilinear(fields.surface_fuel, row, column)
    intensity = constants.HEAT_OF_COMBUSTION / 1000.0 * fuel * speed
    formula = shot.full.settings.fire.flame_length
    return flame_size.flame_length(intensity, formula, canopy > flame_size.CROWNS) * (fuel > _LEAST_FUEL)


def unevenness(shot: Any, place: Array, even: Array) -> Array:
    """Return a factor (n,) on mean flame lengths (m) at scene points (n, 2), m; 0 in gaps of the front."""
    east, north = place.T
    seed, scale = shot.full.settings.seed, pattern_scale(shot)
    crowded = noise.smoothstep(*flame_noise.EVEN, even)
    factor = np.ones(len(even))
    flaring = np.flatnonzero(crowded < 1.0)
    factor[flaring] = flame_noise.flare_factor(east[flaring], north[flaring], even[flaring], scale, seed)
    for index, (size, low, tall) in enumerate(_UNEVEN):
        wave = noise.fractal(east, north, size * scale, 1, seed + 550 + index)
        factor *= np.exp((low + (tall - low) * crowded) * wave)
    crowns = np.flatnonzero(crowded > 0.0)
    clumps = flame_noise.clumping(shot, east[crowns], north[crowns])
    sparse = (1.0 - _BETWEEN) * (1.0 - noise.smoothstep(*flame_noise.CLUMPS, clumps))
    factor[crowns] *= 1.0 - crowded[crowns] * sparse
    factor = np.minimum(factor, _TALL)
    factor *= flame_noise.surge_factor(east, north, even, seed) ** (1.0 - _CROWN_SURGE * crowded)
    broken = np.flatnonzero(flame_noise.gap_fraction(even) > 0.0)
    margin = flame_noise.gap_margin(east[broken], north[broken], even[broken], scale, seed)
    factor[broken] *= noise.smoothstep(-0.06, 0.06, margin)
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
