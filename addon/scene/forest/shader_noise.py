"""Blender's noise texture in NumPy, so that plants match the noise of the ground's material.

Gradient noise in three dimensions as in ``intern/cycles/kernel/svm/noise.h`` and ``hash.h`` of Blender:
Perlin's improved noise (2002) with gradients by the hash of Jenkins (lookup3, 2006).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_SCALE = 0.9820  # scales values to -1..1
_START = np.uint32(0xDEADBEEF + (3 << 2) + 13)
_TURNS = (14, 11, 25, 16, 4, 14, 24)

Array = NDArray[np.float64]


def fractal(position: Array, size: float, octaves: int, roughness: float) -> Array:
    """Fractal noise (n,) 0..1 at points (n, 3), m: equals `Grain.noise` where pixels are small."""
    total, weight, whole = np.zeros(len(position)), 1.0, 0.0
    for octave in range(octaves + 1):
        total += weight * _perlin(position * (2.0**octave / size))
        whole += weight
        weight *= roughness
    return 0.5 * total / whole + 0.5


def _perlin(place: Array) -> Array:
    """Signed Perlin noise (n,) of wavelength 1 at points (n, 3)."""
    low = np.floor(place)
    off = place - low
    fade = off**3 * (off * (off * 6.0 - 15.0) + 10.0)
    cell = low.astype(np.int64)
    total = np.zeros(len(place))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, fade, 1.0 - fade), axis=1)
        total += weight * _gradient(_hash(cell + corner), *(off - corner).T)
    return _SCALE * total


def _gradient(number: NDArray[np.uint32], x: Array, y: Array, z: Array) -> Array:
    low = number & 15
    u = np.where(low < 8, x, y)
    v = np.where(low < 4, y, np.where((low == 12) | (low == 14), x, z))
    return np.where(low & 1, -u, u) + np.where(low & 2, -v, v)


def _hash(cell: NDArray[np.int64]) -> NDArray[np.uint32]:
    """Hash of lattice points (n, 3)."""
    x, y, z = (cell[:, k].astype(np.uint32) for k in range(3))
    a, b, c = _START + x, _START + y, _START + z
    for step, turn in enumerate(_TURNS):
        if step % 3 == 0:
            c = (c ^ b) - _turned(b, turn)
        elif step % 3 == 1:
            a = (a ^ c) - _turned(c, turn)
        else:
            b = (b ^ a) - _turned(a, turn)
    return c


def _turned(number: NDArray[np.uint32], by: int) -> NDArray[np.uint32]:
    return (number << np.uint32(by)) | (number >> np.uint32(32 - by))
