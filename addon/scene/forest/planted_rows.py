"""Plantations: trees of one age in rows, in compartments that differ in age and direction. Without Blender.

All is a function of position, so that it is the same in every shot. Sizes and shares are by eye.
"""

from __future__ import annotations

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...shot.shot import Shot
from ...shot.surface import land_use
from ...shot.terrain import noise
from . import biomes, field_lines

ROW = 6.5  # m between rows of a plantation on a land use map
_COMPARTMENT = (430.0, 310.0)  # m
_RIDE = 6.0  # m, half the width of the open strip between compartments
_FELLED = 6  # every sixth row was felled, so that machines can pass
_AGES = (0.55, 1.10)  # height of the youngest and of the oldest compartment / height by fuel
_UNEVEN = 0.05  # standard deviation of height within a compartment
_SEED = 640

Array = NDArray[np.float64]


def planted(shot: Shot, position: Array) -> NDArray[np.bool_]:
    """Find points (n, 3) in plantations: everywhere in a biome with rows, else on the land use map."""
    if biomes.choose(shot).biome.rows > 0.0:
        return np.ones(len(position), bool)
    return land_use.planted(shot, position)


def align(shot: Shot, position: Array, chosen: NDArray[np.bool_]) -> Array:
    """Move chosen points (n, 3) sideways onto the rows of their compartment, m."""
    if not chosen.any():
        return position
    moved = position.copy()
    turn, row, across = _across(shot, position[chosen])
    off = np.round(across / row) * row - across
    moved[chosen, 0] -= off * np.sin(turn)
    moved[chosen, 1] += off * np.cos(turn)
    return moved


def heights(shot: Shot, position: Array, key: NDArray[np.int64]) -> Array:
    """Heights (n,) of planted trees, m, from the mean diameter by canopy fuel, by compartment."""
    ground, (x, y) = shot.ground, position[:, :2].T
    fuel = np.maximum(bilinear(ground.fields.canopy_fuel, *ground.under(position)), 0.05)
    inches = 0.30 * fuel**0.25 / 0.0254  # mean diameter of the stand, as in the core
    tall = 0.3048 * (4.5 + np.exp(4.86039 - 9.32795 / (inches + 1.0)))
    age = _AGES[0] + (_AGES[1] - _AGES[0]) * _lot(shot, x, y, 1) ** 0.5
    lots = (noise.uniform(key[:, 0], key[:, 1], shot.settings.seed + _SEED + use) for use in (2, 3))
    return tall * age * np.exp(_UNEVEN * noise.normal(*lots))


def stocked(shot: Shot, position: Array) -> Array:
    """Return 0 between compartments and in the rows that were felled for machines, 1 elsewhere (n,)."""
    if not len(position):
        return np.ones(0)
    off = field_lines.fields(field_lines.NUMPY, position[:, 0], position[:, 1], _COMPARTMENT)[0]
    _, row, across = _across(shot, position)
    return ((off > _RIDE) & (np.round(across / row) % _FELLED != 0.0)).astype(np.float64)


def _across(shot: Shot, position: Array) -> tuple[Array, float, Array]:
    """Direction of the rows (radians), the distance between them, and distances (n,) across them, m."""
    x, y = position[:, :2].T
    turn = np.pi * _lot(shot, x, y, 0)
    return turn, biomes.choose(shot).biome.rows or ROW, y * np.cos(turn) - x * np.sin(turn)


def _lot(shot: Shot, x: Array, y: Array, use: int) -> Array:
    """Random number (n,) 0..1 of the compartment at each point."""
    _, row, number = field_lines.fields(field_lines.NUMPY, x, y, _COMPARTMENT)
    return noise.uniform(row.astype(np.int64), number.astype(np.int64), shot.settings.seed + _SEED + use)
