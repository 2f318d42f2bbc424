"""What the fire does to trees: from the fireline intensity where each stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...shot.fire import burning
from ...shot.shot import Shot
from ...shot.terrain import noise
from ...shot.terrain.terrain import bilinear

_UNEVEN = 0.4  # standard deviation of the logarithm of intensity from tree to tree (assumed)
_BASE = 0.1  # of a tree's height: where branches, or young trees under it, take flames up (assumed)
_MOISTURE = 100.0  # % of the needles' dry weight (assumed: the least of a dry autumn)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FireEffects:
    """What becomes of n trees when the fire comes.

    Attributes
    ----------
    scorch
        (n,) part 0..1 of the height below which heat browns the needles.
    torched
        (n,) whether the crown burns.
    """

    scorch: Array
    torched: NDArray[np.bool_]


def of_trees(shot: Shot, row: Array, column: Array, height: Array, key: NDArray[np.int64]) -> FireEffects:
    """Fate of trees (n,), `height` m tall, at fractional rows and columns; chance hangs on keys (n, 2)."""
    seed = shot.settings.seed
    lot = (noise.uniform(*key.T, seed + 310 + use) for use in range(2))
    intensity = surface_intensity(shot, row, column) * np.exp(_UNEVEN * noise.normal(*lot))
    return FireEffects(
        np.clip(scorch_height(intensity) / np.maximum(height, 0.1), 0.0, 1.0),
        intensity > torching_intensity(_BASE * height),
    )


def surface_intensity(shot: Shot, row: Array, column: Array) -> Array:
    """Intensity (kW/m) of the fire on the ground: H w R with its fuel w (Byram 1959)."""
    ground = shot.ground
    fuel = bilinear(ground.fields.surface_fuel, row, column)
    return burning.HEAT / 1000.0 * fuel * ground.spread(row, column)


def scorch_height(intensity: ArrayLike) -> Array:
    """Height (m) to which a fire of `intensity` kW/m kills needles: 0.1483 I^(2/3).

    Van Wagner (1973, Can. J. For. Res. 3:373-378), in air of 25 C without wind; in SI by Alexander (1982).
    """
    return 0.1483 * np.asarray(intensity, np.float64) ** (2.0 / 3.0)


def torching_intensity(base: ArrayLike) -> Array:
    """Intensity (kW/m) from which a crown that begins `base` m up burns: (0.010 z (460 + 25.9 m))^1.5.

    Van Wagner (1977, Can. J. For. Res. 7:23-34), with a foliar moisture content m of `_MOISTURE`.
    """
    return (0.010 * np.asarray(base, np.float64) * (460.0 + 25.9 * _MOISTURE)) ** 1.5
