"""Gradient noise and hashed random numbers by position, for relief and patches."""

from __future__ import annotations

import numpy as np
from firetwin_core import terrain
from numpy.typing import ArrayLike, NDArray


def uniform(x: ArrayLike, y: ArrayLike, seed: int) -> NDArray[np.float64]:
    """Random numbers 0..1 that depend on integers (x, y) and the seed alone."""
    return terrain.uniform(np.asarray(x, np.int64), np.asarray(y, np.int64), seed)


def normal(first: ArrayLike, second: ArrayLike) -> NDArray[np.float64]:
    """Compute normal deviates from two uniform ones (Box and Muller 1958)."""
    first, second = np.asarray(first, np.float64), np.asarray(second, np.float64)
    return np.sqrt(-2.0 * np.log1p(-first * 0.9999)) * np.cos(2.0 * np.pi * second)


def perlin(x: ArrayLike, y: ArrayLike, seed: int) -> NDArray[np.float64]:
    """Gradient noise of wavelength 1, about -1..1 (Perlin 2002: quintic fade)."""
    x, y = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    return terrain.perlin(x.ravel(), y.ravel(), seed).reshape(x.shape)


def fractal(
    x: ArrayLike, y: ArrayLike, size: float, octaves: int, seed: int, roughness: float = 0.5
) -> NDArray[np.float64]:
    """Fractal noise: octaves of gradient noise from wavelength `size` down; standard deviation about 0.4."""
    total, amplitude = np.zeros(np.broadcast(x, y).shape), 1.0
    for octave in range(octaves):
        scale = 2.0**octave / size
        total += amplitude * perlin(np.asarray(x) * scale, np.asarray(y) * scale, seed + octave)
        amplitude *= roughness
    return total


def smoothstep(low: float, high: float, x: ArrayLike) -> NDArray[np.float64]:
    """0 at `low` and below, 1 at `high` and above, smooth between (reversed where high < low)."""
    w = np.clip((np.asarray(x, np.float64) - low) / (high - low), 0.0, 1.0)
    return w * w * (3.0 - 2.0 * w)
