"""Surface and canopy fuel around the King Fire, from height, aspect, wetness and patchiness.

Blue oak and grass on the low foothills, mixed conifer in the middle, red fir and granite high. Invented, but
of the right kind and amount: as many cells have canopy and surface fuel as in the published King Fire scene
(363,632 trees and 419,048 grass clumps on 518,400 cells).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .fractal import fractal, smooth
from .grid import FUEL_CELL_SIZE, cell_of
from .history import Event
from .terrain import Terrain

CANOPY_CELLS = 363_632
SURFACE_CELLS = 419_048
BARE_RIVER_SHARE = 0.6  # of a large river's cells: the water and its gravel fill only part of 74 m
BARE_ROAD_SHARE = 0.7  # of a main road's cells


@dataclass(frozen=True)
class Fuels:
    """Fuel loads (fy, fx) in kg/m2 of dry matter, 0 in bare cells, and slope (rise/run) and aspect.

    Aspect is the downhill direction in degrees clockwise from north.
    """

    surface: NDArray[np.float32]
    canopy: NDArray[np.float32]
    slope: NDArray[np.float64]
    aspect: NDArray[np.float64]


def make(event: Event, terrain: Terrain, seed: int = 720) -> Fuels:
    """Spread fuels over the terrain; a few seconds."""
    height = terrain.elevation
    slope, aspect = slope_and_aspect(height)
    northness = np.cos(np.radians(aspect)) * np.minimum(slope / 0.4, 1)
    wetness = np.clip((np.log10(smooth(terrain.stream, 1.5) / (slope + 0.05)) - 5) / 2, -1, 1.5)
    patches = fractal(height.shape, seed, 60, 3, 1.3)
    stands = fractal(height.shape, seed + 1, 24, 3, 0.9)
    outcrops = fractal(height.shape, seed + 2, 110, 3, 1.4)

    bare = terrain.water | _rivers(terrain, seed + 3) | _roads(event, height.shape, seed + 4)
    granite = 1.5 * _between(height, 1700, 2700) + 1.0 * _between(slope, 0.35, 0.75) + 0.6 * outcrops
    trees = (
        1.1 * _between(height, 450, 950)
        - 1.3 * granite
        + 0.5 * northness
        + 0.35 * wetness
        + 0.55 * patches
        + 0.35 * stands
    )
    has_canopy = _highest(np.where(bare, -np.inf, trees), CANOPY_CELLS)
    ground = np.where(has_canopy, np.inf, 0.5 * patches - 1.6 * granite + 0.3 * wetness)
    has_surface = _highest(np.where(bare, -np.inf, ground), SURFACE_CELLS)

    heavy = 0.30 + 0.95 * _between(height, 500, 1250) - 0.45 * _between(height, 1900, 2600)
    vigour = np.exp(0.32 * patches + 0.34 * stands + 0.20 * northness + 0.14 * np.clip(wetness, -1, 1))
    canopy = np.clip(heavy * vigour, 0.05, 3.2)
    litter = (0.35 + 1.6 * _between(height, 600, 1400) - 0.7 * _between(height, 1900, 2600)) * np.sqrt(vigour)
    open_ground = 0.28 + 0.75 * _between(height, 700, 1300) * _between(patches, -1.5, 0.5)  # grass to brush
    surface = np.where(has_canopy, litter + 0.35 * canopy, open_ground * np.exp(0.25 * stands))
    return Fuels(
        np.where(has_surface, np.maximum(surface, 0.08), 0).astype(np.float32),
        np.where(has_canopy, canopy, 0).astype(np.float32),
        slope,
        aspect,
    )


def slope_and_aspect(height: NDArray, cell_size: float = FUEL_CELL_SIZE) -> tuple[NDArray, NDArray]:
    """Rise over run and downhill direction (degrees clockwise from north) by central differences."""
    north, east = np.gradient(height, cell_size)
    return np.hypot(north, east), np.degrees(np.arctan2(-east, -north)) % 360


def _between(value: NDArray, low: float, high: float) -> NDArray[np.float64]:
    """0 below `low`, 1 above `high`, smooth between (Hermite cubic)."""
    t = np.clip((value - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def _highest(score: NDArray, count: int) -> NDArray[np.bool_]:
    """Exactly the `count` cells of highest score; equal scores by position."""
    chosen = np.zeros(score.size, dtype=bool)
    chosen[np.argsort(-score, axis=None, kind="stable")[:count]] = True
    return chosen.reshape(score.shape)


def _rivers(terrain: Terrain, seed: int) -> NDArray[np.bool_]:
    large = terrain.stream >= 5e7
    return large & (np.random.default_rng(seed).random(large.shape) < BARE_RIVER_SHARE)


def _roads(event: Event, shape: tuple[int, int], seed: int) -> NDArray[np.bool_]:
    """Cells of the sketched main roads, winding a little."""
    road = np.zeros(shape, dtype=bool)
    bend = [3.0 * fractal(shape, seed + axis, 30, 5, 1.2) for axis in (1, 2)]
    for line in event.roads.values():
        row, column = (array.astype(float) for array in cell_of(*np.array(line).T))
        along = np.concatenate([[0], np.cumsum(np.hypot(np.diff(row), np.diff(column)))])
        fine = np.arange(0, along[-1], 0.5)
        r, c = np.interp(fine, along, row).astype(int), np.interp(fine, along, column).astype(int)
        on_map = (r >= 0) & (r < shape[0]) & (c >= 0) & (c < shape[1])
        r, c = r[on_map], c[on_map]
        r = np.clip(np.rint(r + bend[0][r, c]).astype(int), 0, shape[0] - 1)
        c = np.clip(np.rint(c + bend[1][r, c]).astype(int), 0, shape[1] - 1)
        road[r, c] = True
    return road & (np.random.default_rng(seed).random(shape) < BARE_ROAD_SHARE)
