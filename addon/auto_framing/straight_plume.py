"""Straight plume model: approximate optical depth of smoke between a camera and the front, before solving."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ..shot.fire import emissions
from ..shot.terrain.terrain import NEVER, Terrain

_LONG = 3.0  # burn-out times after which a cell counts as cold
_WIDE = 0.4  # half-width of a plume over its drift distance (by eye)
# m4/s3 of buoyancy flux for a kg/s of fuel.
_BUOYANCY = constants.BUOYANCY_FLUX * constants.HEAT_OF_COMBUSTION
_BRIGGS = 1.6  # bent-over plume: rise 1.6 F^(1/3) x^(2/3) / U at x m (Briggs 1971)
_RISES = (0.2, 2.0)  # rise over drift distance, for straight plumes in place of bent ones (assumed)
_WEAK = 2.0  # m/s, lower limit of wind, as fires draw air in
_BLOCKS = 7  # blocks along the longer side, in which sources are merged
_STEPS, _NEAR = 16, 0.01  # samples along a line of sight, from this fraction of it on

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StraightPlume:
    """Plumes at one time.

    Attributes
    ----------
    source, rate
        Source points (k, 3), m, and fuel consumption rates (k,), kg/s.
    wind
        Drift velocity (2,), m/s.
    least
        Half-width at the source, m.
    rise
        Rise over drift distance.
    """

    source: Array
    rate: Array
    wind: Array
    least: float
    rise: float

    def _density(self, point: Array, axis: Array) -> Array:
        """Smoke (n,) at points (n, 3) per length of the plumes along their axis (3,), kg/(m s)."""
        away = point[:, None] - self.source  # (n, sources, 3); one step at a time fits into the cache
        along = away @ axis
        away *= away
        across = away[..., 0] + away[..., 1]
        across += away[..., 2]
        across -= along**2
        np.sqrt(np.maximum(across, 0.0, out=across), out=across)
        half = self.least + _WIDE * np.maximum(along, 0.0)
        inside = (along > 0.0) & (across < half)
        dense = np.zeros_like(half)
        np.divide(np.broadcast_to(self.rate, half.shape), np.pi * half**2, out=dense, where=inside)
        return dense.sum(axis=-1)

    def depth(self, eye: Array, place: Array) -> Array:
        """Optical depth (n,) of smoke between a camera and points (n, 3).

        Smoke is uniform across a plume, which drifts downwind, rises and widens linearly. Without wind it
        stands over its source.
        """
        if len(self.rate) == 0 or len(place) == 0:
            return np.zeros(len(place))
        speed = float(np.hypot(*self.wind))
        axis = np.array([*self.wind / speed, self.rise]) if speed > 0.0 else np.array([0.0, 0.0, 1.0])
        axis /= np.linalg.norm(axis)
        part = np.geomspace(_NEAR, 1.0, _STEPS)
        dense = np.stack([self._density(place + step * (eye - place), axis) for step in part])
        pieces = np.gradient(part)[:, None] * np.linalg.norm(eye - place, axis=1)
        return emissions.EXTINCTION / max(speed, _WEAK) * (dense * pieces).sum(axis=0)


def trace(
    ground: Terrain, near: tuple[slice, slice], crossing: Array, time: float, wind: Array
) -> StraightPlume:
    """Trace the plumes at a time (s).

    Parameters
    ----------
    near, crossing
        Rows and columns of the grid that contain all that burns, and crossing time of the front through each
        of their cells, s.
    """
    fields = ground.fields
    arrival = ground.arrival[near]
    surface, canopy = fields.surface_fuel[near], fields.canopy_fuel[near]
    kind = emissions.kind(surface, canopy)
    burn_out = np.maximum(crossing, emissions.burn_out(surface, kind))
    with np.errstate(over="ignore", invalid="ignore"):
        age = (time - arrival) / burn_out
    row, column = np.nonzero((arrival < NEVER) & (age >= 0.0) & (age < _LONG))
    per_kg = emissions.column("smoke", 0)
    smoke = (surface * per_kg[kind] + canopy * per_kg[emissions.CROWN])[row, column]
    burns = ground.cell[0] * ground.cell[1] * np.exp(-age[row, column]) / burn_out[row, column]
    fuel = float((burns * (surface + canopy)[row, column]).sum())
    row, column = row + near[0].start, column + near[1].start
    point = ground.frame.forward(
        fields.latitude[row], fields.longitude[column], fields.elevation[row, column]
    )
    return StraightPlume(
        *_merged(point, smoke * burns), wind, 0.5 * max(ground.cell), _rise(point, fuel, wind)
    )


def _rise(point: Array, fuel: float, wind: Array) -> float:
    """Rise over drift distance of a whole fire's plume, at a drift of a third of the fire's size.

    Parameters
    ----------
    fuel
        Fuel consumption rate, kg/s.
    """
    if len(point) == 0:
        return _RISES[0]
    way = max(float(np.hypot(*np.ptp(point[:, :2], axis=0))) / 3.0, 100.0)
    slope = _BRIGGS * (_BUOYANCY * fuel / way) ** (1.0 / 3.0) / max(float(np.hypot(*wind)), _WEAK)
    return float(np.clip(slope, *_RISES))


def _merged(point: Array, rate: Array) -> tuple[Array, Array]:
    """Merge sources (n, 3) with rates (n,) by block, at their centres."""
    if rate.sum() <= 0.0:
        return np.empty((0, 3)), np.empty(0)
    size = max(float(np.ptp(point[:, :2], axis=0).max()) / _BLOCKS, 1.0)
    _, block = np.unique(np.floor(point[:, :2] / size), axis=0, return_inverse=True)
    total = np.bincount(block.ravel(), rate).astype(np.float64, copy=False)
    centre = np.stack([np.bincount(block.ravel(), rate * point[:, k]) for k in range(3)], axis=-1)
    some = total > 0.0
    return centre[some] / total[some, None], total[some]
