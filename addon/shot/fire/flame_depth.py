"""Flame depth of the front: rate of spread times residence time.

It does not depend on the grid's cell size. It is less at the flanks and the rear than at the head.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core import constants
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import fuel_category
from . import emissions, long_burning

if TYPE_CHECKING:
    from ..terrain.terrain import Terrain

_FULL_DEPTH = 60.0  # m, flame depth of a crown fire, at which patterns have their full size
_LEAST_SCALE = 0.15  # lower bound of the relative pattern size
_HEAD_PERCENTILE = 95.0  # percentile of flame depth along the front that stands for the head
_BEFORE = 600.0  # s before the first frame for which the front is included

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FrontFields:
    """Properties of the fire front on a terrain grid.

    Parameters
    ----------
    ground
        Terrain with its apron.
    run
        Run that supplies the fuel.
    """

    ground: Terrain
    run: Run

    @cached_property
    def kind(self) -> NDArray[np.int8]:
        """Kind of surface fuel (ny, nx), of `emissions.KINDS`."""
        fields, run, category = self.ground.fields, self.run, None
        if run.has(fuel_category.FIELD):
            numbers = run.fuel_rows(fuel_category.FIELD, 0, len(run.fuel_latitude))
            category = self.ground.padded(numbers, run.fuel_latitude, run.fuel_longitude)
        return emissions.kind(fields.surface_fuel, fields.canopy_fuel, category)

    @cached_property
    def speed(self) -> Array:
        """Rate of spread (ny, nx), m/s; 1 where it does not burn."""
        row, column = np.nonzero(self.ground.burned > 0.0)
        rate = np.ones(self.ground.shape)
        rate[row, column] = self.ground.spread(row.astype(np.float64), column.astype(np.float64))
        return rate

    @cached_property
    def residence(self) -> Array:
        """Residence time of flames (ny, nx), s; longer where the run's heat flux stays intense."""
        of_fuel, run = emissions.column("residence")[self.kind], self.run
        intense = long_burning.duration(run)
        if intense is None:
            return of_fuel
        return np.maximum(of_fuel, self.ground.padded(intense, run.fuel_latitude, run.fuel_longitude))

    @cached_property
    def intensity(self) -> Array:
        """Fireline intensity of the surface fire (ny, nx), kW/m: H w R (Byram 1959); 0 if nothing burns."""
        burned = np.where(self.ground.burned > 0.0, self.ground.fields.surface_fuel, 0.0)
        return constants.HEAT_OF_COMBUSTION / 1000.0 * burned * self.speed

    @cached_property
    def ash(self) -> Array:
        """Brightness of the ash (ny, nx), 0..1."""
        return emissions.column("ash")[self.kind]


def head(front: FrontFields, first: float, last: float) -> float:
    """Flame depth at the head of the front between two model times (s), m; 0 without fire."""
    ground = front.ground
    passed = (ground.burned >= 0.5) & (ground.arrival <= last) & (ground.arrival >= first - _BEFORE)
    if not passed.any():
        return 0.0
    return float(np.percentile((front.speed * front.residence)[passed], _HEAD_PERCENTILE))


def scale(front: FrontFields, first: float, last: float) -> float:
    """Pattern size of flaming front and burn scar relative to a crown fire's, at most 1."""
    deep = head(front, first, last)
    return float(np.clip(deep / _FULL_DEPTH, _LEAST_SCALE, 1.0)) if deep else 1.0
