"""Smoke of a front below the flow's cells: clear air upwind of the flames, and its smoke downwind of them.

Needs no Blender. The cells of a flow are wider than a front. They spread its smoke upwind, where real air is
clear. Near the ground the flames within the cells decide instead: smoke begins at them and trails downwind.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ..shot.fire import emissions, flame_map
from ..shot.fire.fuel import BURN_OUT_CANOPY
from ..shot.fire.smoke_scale import Scale
from ..shot.shot import Shot
from ..shot.terrain import noise

LEAN = 0.8  # shift downwind of rising smoke over its height (flames of a running front lean by 40 degrees)
HEIGHT = 200.0  # m, height at which the cells spread smoke no wider than the plume is; scales with the cells
LEVELS = 2  # lowest levels whose mean age tells where smoke comes from
# cells, half-width of a source, and length over which smoke thins downwind (by eye)
_WIDTH, _TRAIL = 0.12, 0.75
_SPREAD = 1.0  # cells, standard deviation by which the flow and its interpolation spread smoke (assumed)
_BACKGROUND = 0.02  # smoke of other origin, relative to the densest
_LIMITS = -5.0, 1.2  # logarithm of the factor on smoke
_REACH = 2.0  # cells, length over which smoke stays near the ground downwind of its source (by eye)
_SMOKY = 0.05, 0.5  # smoke from upwind over smoke of the front, in clear and in smoky air (by eye)
_NEAR = 250.0, 600.0  # m from a front within which air may be clear; with the root of the scale (by eye)
_FRONT = 0.1  # strength of sources that count as a front, relative to strong ones
_SAMPLES, _FINE = 2, 8.0  # samples of the flames along a voxel wider than this, m
_LONGEST = 1200.0  # s after arrival in which flames are looked for
_OLD = 60.0, 240.0  # s, ages of smoke that has come from fronts far upwind; scale with the cells

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sources:
    """Sources of smoke at points (nx, ny): squared flame length, m2, and emission in any unit."""

    flames: Array
    emission: Array


def find_sources(shot: Shot, time: float, x: Array, y: Array) -> Sources:
    """Return the sources of smoke at a model time (s), at evenly spaced points, m."""
    step = float(x[1] - x[0])
    place = np.stack([np.repeat(x, len(y)), np.tile(y, len(x))], axis=-1)
    row, column = shot.ground.indices(*shot.ground.geodetic(*place.T))
    age = time - bilinear(shot.ground.burn_time, row, column)
    at = np.flatnonzero(np.abs(age) < _LONGEST)
    flames, emission = np.zeros((2, len(place)))
    every = _SAMPLES if step > _FINE else 1
    shifts = ((np.arange(every) + 0.5) / every - 0.5) * step
    for east in shifts:
        for north in shifts:
            points = place[at] + (east, north)
            where = shot.ground.indices(*shot.ground.geodetic(*points.T))
            flames[at] += flame_map.lengths(shot, points, *where, time) ** 2 / every**2
    fields = shot.ground.fields
    slow = emissions.burn_out(np.nan_to_num(fields.surface_fuel), shot.front.kind)
    at = np.flatnonzero(age > 0.0)
    row, column, age = row[at], column[at], age[at]
    for load, last in (
        (fields.surface_fuel, slow),
        (fields.canopy_fuel, np.full(slow.shape, BURN_OUT_CANOPY)),
    ):
        until = bilinear(last, row, column)
        emission[at] += bilinear(np.nan_to_num(load), row, column) * np.exp(-age / until) / until
    return Sources(flames.reshape(len(x), len(y)), emission.reshape(len(x), len(y)))


def log_gain(
    sources: Sources, step: float, scale: Scale, cell: float, wind: tuple[float, float]
) -> Array | None:
    """Return the logarithm of a factor (nx, ny) on smoke at the ground; None without flames.

    Parameters
    ----------
    step, cell
        Spacing of the sources, and width of the flow's cells, m.
    wind
        Wind to the east and north, m/s.
    """
    if not sources.flames.any():
        return None
    gain = redistribution(sources.flames, step, cell, wind)
    clear = clear_air(sources, step, cell, wind, np.sqrt(scale.ratio))
    return np.maximum(gain + _LIMITS[0] * clear, _LIMITS[0])


def clear_air(
    sources: Sources, step: float, cell: float, wind: tuple[float, float], scale: float = 1.0
) -> Array:
    """Return how clear the air near fronts is, 0..1 (nx, ny): 1 where no ground smokes upwind."""
    waves = _Waves(sources.emission.shape, step)
    smoke = waves.filter(sources.emission, waves.trail(_REACH * cell, max(_WIDTH * cell, 0.5 * step), wind))
    front = sources.flames > _FRONT * np.percentile(sources.flames[sources.flames > 0.0], 90.0)
    smoky = noise.smoothstep(*_SMOKY, smoke / max(float(np.median(smoke[front])), 1.0e-30))
    limits = [scale * limit for limit in _NEAR]
    far = noise.smoothstep(limits[0], limits[1], _distance(front, step, 0.5 * limits[1]))
    return (1.0 - far) * (1.0 - smoky)


def _distance(front: NDArray[np.bool_], step: float, width: float) -> Array:
    """Estimate the distance (nx, ny) from a front, m, by a Gaussian blur of a width (m)."""
    waves = _Waves(front.shape, step)
    blurred = waves.filter(front.astype(np.float64), np.exp(-0.5 * waves.square * width**2))
    share = np.clip(blurred / float(np.median(blurred[front])), 1.0e-12, 1.0)
    return width * np.sqrt(-2.0 * np.log(share))


class _Waves:
    """Wave numbers of points (nx, ny) every `step` m, padded as the transform is periodic."""

    def __init__(self, shape: tuple[int, ...], step: float) -> None:
        self.count, self.padded = shape, [2 * count for count in shape]
        self.east = 2.0 * np.pi * np.fft.fftfreq(self.padded[0], step)[:, None]
        self.north = 2.0 * np.pi * np.fft.rfftfreq(self.padded[1], step)[None, :]
        self.square = self.east**2 + self.north**2

    def filter(self, values: Array, response: NDArray) -> Array:
        """Filter values (nx, ny) by a response to waves."""
        found = np.fft.irfft2(np.fft.rfft2(values, self.padded) * response, self.padded)
        return np.maximum(found[: self.count[0], : self.count[1]], 0.0)

    def trail(self, length: float, width: float, wind: tuple[float, float]) -> NDArray[np.complex128]:
        """Return the response of smoke that thins downwind over a length (m), from sources of a width (m)."""
        speed = max(float(np.hypot(*wind)), 1.0e-6)
        along = (self.east * wind[0] + self.north * wind[1]) / speed
        return np.exp(-0.5 * self.square * width**2) / (1.0 + 1j * along * length)


def redistribution(source: Array, step: float, cell: float, wind: tuple[float, float]) -> Array:
    """Return the logarithm of fine over coarse smoke (nx, ny) of sources every `step` m in a wind (m/s).

    Fine smoke trails downwind of its source. Coarse smoke is the same, spread as the cells spread it, so both
    have the same mass. Without smoke the result is 0.
    """
    if not source.any():
        return np.zeros(source.shape)
    waves = _Waves(source.shape, step)
    trail = waves.trail(_TRAIL * cell, max(_WIDTH * cell, 0.5 * step), wind)
    spread = np.exp(-0.5 * waves.square * (_SPREAD * cell) ** 2)
    fine, coarse = (waves.filter(source, each) for each in (trail, trail * spread))
    least = _BACKGROUND * float(coarse.max())
    return np.clip(np.log((fine + least) / (coarse + least)), *_LIMITS)


def local_share(age: Array, scale_time: float) -> Array:
    """Return the share of smoke, 0 to 1, that comes from flames near by, from its age (s)."""
    young, old = (scale_time * limit for limit in _OLD)
    return 1.0 - noise.smoothstep(young, old, age)
