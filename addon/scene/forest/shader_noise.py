"""Blender's noise texture, so that plants match the noise of the ground's material.

Gradient noise in three dimensions as in ``intern/cycles/kernel/svm/noise.h`` and ``hash.h`` of Blender:
Perlin's improved noise (2002) with gradients by the hash of Jenkins (lookup3, 2006).
"""

from __future__ import annotations

import numpy as np
from firetwin_core import terrain
from numpy.typing import NDArray

_SCALE = 0.9820  # scales values to -1..1

Array = NDArray[np.float64]


def fractal(position: Array, size: float, octaves: int, roughness: float) -> Array:
    """Fractal noise (n,) 0..1 at points (n, 3), m.

    It equals `band_limited_noise.Grain.noise` where pixels are small.
    """
    total, weight, whole = np.zeros(len(position)), 1.0, 0.0
    for octave in range(octaves + 1):
        total += weight * _SCALE * terrain.perlin_in_space(position * (2.0**octave / size))
        whole += weight
        weight *= roughness
    return 0.5 * total / whole + 0.5
