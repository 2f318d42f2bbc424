"""Procedural patterns of open land: wetness, valleys and bushes, shared by the ground's material and plants.

One implementation serves both: numbers are a node tree's `Value`s in the ground's material, and `Numbers` for
plants. Sizes (m) and shares are by eye.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...shot.terrain import noise as shot_noise
from . import shader_noise
from .biomes import OpenLand

Noise = Callable[[float, float, float], Any]
"""Noise of a wavelength (m), with a number of octaves and a roughness: 0..1."""


@dataclass(frozen=True)
class Numbers:
    """Numbers (n,) with the operations of a node tree's `Value`."""

    value: NDArray[np.float64]

    def __add__(self, other: Any) -> Numbers:
        return Numbers(self.value + _plain(other))

    def __sub__(self, other: Any) -> Numbers:
        return Numbers(self.value - _plain(other))

    def __mul__(self, other: Any) -> Numbers:
        return Numbers(self.value * _plain(other))

    def __truediv__(self, other: Any) -> Numbers:
        return Numbers(self.value / _plain(other))

    def smoothstep(self, low: float, high: float) -> Numbers:
        """0 at `low` and below, 1 at `high` and above, smooth between."""
        return Numbers(shot_noise.smoothstep(low, high, self.value))

    def ramp(self, low: float, high: float, start: float = 0.0, end: float = 1.0) -> Numbers:
        """`start` at `low` and below, `end` at `high` and above, linear between."""
        return Numbers(start + (end - start) * np.clip((self.value - low) / (high - low), 0.0, 1.0))

    def clamp(self) -> Numbers:
        """Clamp to 0..1."""
        return Numbers(np.clip(self.value, 0.0, 1.0))


def _plain(other: Any) -> Any:
    return other.value if isinstance(other, Numbers) else other


def at(place: NDArray[np.float64]) -> Noise:
    """Noise function at points (n, 3) in the scene, m."""
    return lambda size, octaves, roughness: Numbers(
        shader_noise.fractal(place, size, int(octaves), roughness)
    )


def wetness(noise: Noise, hollow: Any, land: OpenLand) -> tuple[Any, Any, Any]:
    """Noise of large and medium patches, 0..1, and wetness, about -1..1.5."""
    broad, middling = noise(land.patch, 4.0, 0.6), noise(130.0, 4.0, 0.65)
    wet = hollow * land.hollows + (broad - 0.5) * 1.9 + (middling - 0.5) * 0.9
    if land.draws:
        wet = wet + draws(noise, middling, land) * 0.8
    return broad, middling, wet


def draws(noise: Noise, middling: Any, land: OpenLand) -> Any:
    """Shallow valleys 0..1 along isolines of noise: they meander, join and end."""
    shape = noise(land.draws, 3.0, 0.45) + (middling - 0.5) * 0.12
    wide = noise(2.6 * land.draws, 2.0, 0.5).ramp(0.35, 0.65, 0.012, 0.055)
    off = (shape - 0.5) / wide
    return (off * off).smoothstep(1.0, 0.02)


def bushes(noise: Noise, shrub: Any, wet: Any, land: OpenLand) -> tuple[Any, Any]:
    """Return groups of bushes, 0..1, and shrub cover, whose mean is about `shrub`."""
    groups = noise(62.0, 4.0, 0.68)
    begin = shrub * -0.33 + 0.645
    cover = (groups + wet * (0.09 * land.hollows) - begin).smoothstep(-0.05, 0.08)
    cover = cover * (shrub * 0.40 + 0.60) + shrub * 0.22
    return groups, cover.clamp() * shrub.smoothstep(0.0, 0.03)
