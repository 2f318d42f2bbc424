"""Noise of flames along a front: patches flare up or creep; it has tongues, gaps and clumps of crowns.

Needs no Blender.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..terrain import noise

_FLARE, _FLARES = 160.0, 1.6  # m, in a crown fire; log deviation of the lengths of low flames (by eye)
EVEN = (5.0, 12.0)  # m, flame lengths between which lengths become uniform
_GAP, _GAPS = 25.0, 0.5  # m, size of gaps in a crown fire; fraction of gaps in a front with the lowest flames
_BROKEN = (0.5, 6.0)  # m, flame lengths at which a front has most gaps, and none
_SURGE, _SURGES, MOST_SURGE = 1.4, 1.1, 1.5
"""Size of tongues in flame lengths, log deviation of the lengths, and the greatest factor (by eye)."""
_CLUMP = 45.0  # m, size of clumps of crowns that burn
CLUMPS = (-0.3, 0.05)  # noise of clumps, from none to full

LAUNCH, LIFT = 1.5, 7.0  # m/s, m/s2: rise of flame gas (see `FlameShape`)

Array = NDArray[np.float64]


def flare_factor(east: Array, north: Array, length: Array, scale: float, seed: int) -> Array:
    """Return a factor (n,) on low flames (m): patches flare up or creep."""
    wave = noise.fractal(east, north, _FLARE * scale, 3, seed + 530)
    return np.exp(_FLARES * wave * (1.0 - noise.smoothstep(*EVEN, length)))


def surge_factor(east: Array, north: Array, length: Array, seed: int) -> Array:
    """Return a factor (n,) on flame lengths (m): tongues and troughs in proportion to the flames.

    Sizes are rounded to powers of two and blended, as the noise would slide where the length varies.
    """
    octave = np.log2(np.maximum(length, 0.1))
    low = np.floor(octave)
    part = octave - low
    wave = np.zeros(len(length))
    for number in np.unique(np.concatenate([low, low + 1.0])):
        weight = np.maximum(1.0 - np.abs(octave - number), 0.0)
        at = np.flatnonzero(weight > 0.0)
        wave[at] += weight[at] * noise.fractal(east[at], north[at], _SURGE * 2.0**number, 1, seed + 580)
    return np.minimum(np.exp(_SURGES * wave / np.hypot(part, 1.0 - part)), MOST_SURGE)


def gap_fraction(length: Array) -> Array:
    """Return the fraction of gaps in a front with flames of this length (m)."""
    return _GAPS * (1.0 - noise.smoothstep(*_BROKEN, length))


def gap_margin(east: Array, north: Array, length: Array, scale: float, seed: int) -> Array:
    """Return the margin (n,) to the gaps of fronts with low flames (m): below 0 in gaps, 1 without any."""
    broken = noise.fractal(east, north, _GAP * scale, 2, seed + 520)  # 0.4 deviate
    gaps = gap_fraction(length)
    return np.where(gaps > 0.0, 0.5 + 0.8 * broken - gaps, 1.0)


def clumping(shot: Any, east: Array, north: Array) -> Array:
    """Return noise (n,) at scene points, m. Crowns burn first in clumps of high values."""
    scale = max(shot.full.front_scale, 0.3)
    return noise.fractal(east, north, _CLUMP * scale, 2, shot.full.settings.seed + 570)


def upright(length: Array, wind: tuple[float, float]) -> Array:
    """Return the height of flames over their length (m), which wind (m/s) leans."""
    flight = (np.sqrt(LAUNCH**2 + 2.0 * LIFT * length) - LAUNCH) / LIFT
    return length / np.maximum(np.hypot(length, np.hypot(*wind) * flight), 1.0e-6)
