"""Kinds of fire that have views: where they burn, and the distances from which they are filmed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ...shot.fire import emissions, flame_size

# m and kW/m (all by eye)
_GRASS, _GRASS_BEST = (0.4, 6.0), 1.5
_SURFACE, _SURFACE_BEST = (0.8, 3.0), 2.0
_TORCHING, _TORCHING_BEST, _TORCHING_INTENSITY = (1.5, 12.0), 4.0, 300.0
_CROWN = 8.0
_TREES = 0.1  # kg/m2, canopy fuel from which surface fire burns under trees
_OPEN = 0.8  # kg/m2, canopy fuel over which the preference for open stands falls to 1/e

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Cells:
    """Fire in the cells (ny, nx) of the terrain grid.

    Attributes
    ----------
    length
        Flame length, m.
    intensity
        Intensity of the surface fire, kW/m.
    kind
        Kind of surface fuel, of `emissions.KINDS`.
    canopy
        Canopy fuel, kg/m2.
    """

    length: Array
    intensity: Array
    kind: NDArray[np.int8]
    canopy: Array


@dataclass(frozen=True)
class FireKind:
    """A kind of fire.

    Attributes
    ----------
    distances
        Distances of the cameras from the flames, m.
    suits
        Suitability (ny, nx) of cells; 0: they have no such fire.
    seen
        Points of a flame that must be seen, as parts of its height.
    torches
        True if single crowns burn.
    """

    name: str
    words: str
    distances: tuple[float, ...]
    suits: Callable[[Cells], Array]
    seen: tuple[float, ...] = (0.15, 0.6)
    torches: bool = False


@dataclass(frozen=True)
class LightOfDay:
    """Day or night, by limits of the sun's elevation, degrees."""

    words: str
    suffix: str
    low: float
    high: float


def _like(value: Array, best: float) -> Array:
    """Return 1 at the best value, less by ratio."""
    return np.exp(-(np.log(np.maximum(value, 1.0e-6) / best) ** 2))


def _torching(cells: Cells) -> Array:
    """Return open stands with a surface fire that lights crowns."""
    low, high = _TORCHING
    here = (cells.kind == emissions.LITTER) & (cells.canopy > 2.0 * _TREES)
    here &= (cells.length >= low) & (cells.length <= high) & (cells.intensity >= _TORCHING_INTENSITY)
    return here * _like(cells.length, _TORCHING_BEST) * np.exp(-cells.canopy / _OPEN)


def _surface(cells: Cells) -> Array:
    """Return low flames in litter under trees, the more open the better."""
    low, high = _SURFACE
    here = (cells.kind == emissions.LITTER) & (cells.canopy > _TREES)
    here &= (cells.length >= low) & (cells.length <= high)
    return here * _like(cells.length, _SURFACE_BEST) * np.exp(-cells.canopy / _OPEN)


def _grass(cells: Cells) -> Array:
    """Return grass, best amid grass and away from trees."""
    low, high = _GRASS
    here = (cells.kind == emissions.GRASS) & (cells.length >= low) & (cells.length <= high)
    open_land = 1.0 / (1.0 + dilate(cells.canopy, 1))
    return here * _like(cells.length, _GRASS_BEST) * open_land


def _crown(cells: Cells) -> Array:
    """Return crown fire, the taller it is here and in the cells around, the better."""
    here = (cells.canopy > flame_size.CROWNS) & (cells.length >= _CROWN)
    tall = np.pad(here * cells.length, 1)
    rows, columns = here.shape
    around = sum(tall[y : y + rows, x : x + columns] for y in range(3) for x in range(3))
    return here * np.asarray(around)


KINDS = (
    # trees within 25 m of a camera are not drawn (`scene.forest.stand.CLEARING`)
    FireKind("torching", "torching crown", (30.0, 60.0, 150.0), _torching, (0.3, 0.45, 0.6, 0.75, 0.9), True),
    FireKind("surface", "surface fire under trees", (5.0, 20.0, 60.0), _surface),
    FireKind("grass", "grass fire", (5.0, 20.0), _grass),
    FireKind("crown", "crown run", (60.0, 150.0, 400.0, 2000.0), _crown, (0.4, 0.8)),
)
LIGHTS = (
    LightOfDay("by day", "", 8.0, 90.0),
    LightOfDay("by night", "_night", -90.0, -9.0),  # no twilight left that outshines flames (by eye)
)
