"""Fire effects on trees: scorch height and torching from fireline intensity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ...shot.shot import Shot
from ...shot.terrain import noise

_UNEVEN = 0.4  # standard deviation of the logarithm of intensity between trees (assumed)
_BASE = 0.1  # canopy base height over tree height, with ladder fuels (assumed)
_MOISTURE = 100.0  # % of the needles' dry weight, foliar moisture (assumed: dry autumn's least)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FireEffects:
    """Effects of the fire on n trees.

    Attributes
    ----------
    scorch
        (n,) scorch height as a fraction 0..1 of tree height; needles below it are killed by heat and turn
        brown.
    torched
        (n,) whether the crown burns.
    """

    scorch: Array
    torched: NDArray[np.bool_]


def of_trees(shot: Shot, row: Array, column: Array, height: Array, key: NDArray[np.int64]) -> FireEffects:
    """Fire effects on trees (n,), `height` m tall, at fractional rows and columns; keys (n, 2) are seeds."""
    seed = shot.settings.seed
    lot = (noise.uniform(key[:, 0], key[:, 1], seed + 310 + use) for use in range(2))
    intensity = surface_intensity(shot, row, column) * np.exp(_UNEVEN * noise.normal(*lot))
    return FireEffects(
        np.clip(scorch_height(intensity) / np.maximum(height, 0.1), 0.0, 1.0),
        intensity > torching_intensity(_BASE * height),
    )


def surface_intensity(shot: Shot, row: Array, column: Array) -> Array:
    """Surface fireline intensity (kW/m): H w R with the surface fuel w (Byram 1959)."""
    ground = shot.ground
    fuel = bilinear(ground.fields.surface_fuel, row, column)
    return constants.HEAT_OF_COMBUSTION / 1000.0 * fuel * ground.spread(row, column)


def scorch_height(intensity: ArrayLike) -> Array:
    """Scorch height (m) of a fire of `intensity` kW/m: 0.1483 I^(2/3).

    Van Wagner (1973, Can. J. For. Res. 3:373-378), in air of 25 C without wind; in SI by Alexander (1982).
    """
    return 0.1483 * np.asarray(intensity, np.float64) ** (2.0 / 3.0)


def torching_intensity(base: ArrayLike) -> Array:
    """Critical surface intensity for torching, kW/m, of base height `base` m: (0.010 z (460 + 25.9 m))^1.5.

    Van Wagner (1977, Can. J. For. Res. 7:23-34), with a foliar moisture content m of `_MOISTURE`.
    """
    return (0.010 * np.asarray(base, np.float64) * (460.0 + 25.9 * _MOISTURE)) ** 1.5
