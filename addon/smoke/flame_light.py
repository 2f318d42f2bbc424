"""Flame light on smoke: light sources and their glow in cells. Needs no Blender."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..shot.fire import heat_release
from ..shot.fire.fire import Fire
from ..shot.fire.smoke_scale import Scale

_BLOCK = 300.0  # m, grid on which flames are merged into lights
_COUNT = 400  # lights at most
_FLAME_HEIGHT = 20.0  # m above ground, height of the lights
_POWER, _REACH, _CORE, _EVERY = 1e9, 600.0, 250.0, 3  # W, m, m, cells; at a fire of 15 km

Array = NDArray[np.float64]


def lights(fire: Fire, time: float, scale: Scale) -> tuple[Array, Array]:
    """Merge flames to lights in smoke: positions (n, 3), m, and luminous powers (n,), W."""
    lights = heat_release.lights(fire.luminous(fire.sources(time)), scale.length(_BLOCK), _COUNT)
    return lights.position + np.array([0.0, 0.0, scale.length(_FLAME_HEIGHT)]), lights.power


def glow(
    lights: tuple[Array, Array], heights: Array, spacing: float, corner: tuple[float, float], scale: Scale
) -> NDArray[np.float32]:
    """Compute the glow in cells: sum of P / 1 GW exp(-r / 600 m) / (1 + (r / 250 m)^2).

    It is computed in every third cell. Catmull-Rom splines interpolate it without visible kinks.
    """
    places, power = lights
    reach, core = np.float32(scale.length(_REACH)), np.float32(scale.length(_CORE) ** 2)
    every = [np.unique(np.append(np.arange(0, count, _EVERY), count - 1)) for count in heights.shape]
    z = heights[np.ix_(*every)].astype(np.float32)
    y, x = (
        (low + (at + 0.5) * spacing).astype(np.float32)
        for low, at in zip(corner[::-1], every[1:], strict=True)
    )
    sums = np.zeros(z.shape, np.float32)
    for place, watts in zip(places.astype(np.float32), power, strict=True):
        flat = (x - place[0])[None, None, :] ** 2 + (y - place[1])[None, :, None] ** 2
        square = flat + (z - place[2]) ** 2
        sums += (
            np.float32(watts / (_POWER * scale.ratio**2))
            * np.exp(-np.sqrt(square) / reach)
            / (1.0 + square / core)
        )
    for axis, (at, count) in enumerate(zip(every, heights.shape, strict=True)):
        sums = _interpolated(sums, at, count, axis)
    return sums


def _interpolated(values: NDArray, at: NDArray[np.int64], count: int, axis: int) -> NDArray[np.float32]:
    """Interpolate by splines along an axis from indices `at` to all of its `count` indices."""
    place = np.interp(np.arange(count), at, np.arange(len(at)))
    low = np.minimum(place.astype(np.int64), max(len(at) - 2, 0))
    t = (place - low).astype(np.float32).reshape([-1 if a == axis else 1 for a in range(values.ndim)])
    weights = (  # E. Catmull and R. Rom (1974)
        ((2.0 - t) * t - 1.0) * t,
        (3.0 * t - 5.0) * t * t + 2.0,
        ((4.0 - 3.0 * t) * t + 1.0) * t,
        (t - 1.0) * t * t,
    )
    near = (np.clip(low + step, 0, len(at) - 1) for step in (-1, 0, 1, 2))
    curve = sum(0.5 * w * values.take(n, axis) for w, n in zip(weights, near, strict=True))
    return np.maximum(curve, 0.0)
