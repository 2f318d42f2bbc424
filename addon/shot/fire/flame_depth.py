"""How deep the front's flames are: the rate of spread times how long flames stand over a spot.

So their depth does not hang on the cells of a grid, and is less at the flanks and the rear than at the head.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import fuel_category
from . import emissions

if TYPE_CHECKING:
    from ..settings.protocols import ShotView
    from ..terrain.terrain import Ground

_WHOLE = 60.0  # m; of a front as deep, or deeper, patterns have their full size: a crown fire's
_LEAST = 0.15  # of that size
_STRONG = 95.0  # percentile of the depths along the front: of its head
_AROUND = 600.0  # s before the first frame that the front counts

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Fields:
    """What the front is like on the grid of a ground.

    Parameters
    ----------
    ground
        With its apron.
    run
        Of the fuel.
    """

    ground: Ground
    run: Run

    @cached_property
    def kind(self) -> NDArray[np.int8]:
        """(ny, nx) kind of the surface fuel, of `emissions.KINDS`."""
        fields, run, category = self.ground.fields, self.run, None
        if run.has(fuel_category.FIELD):
            numbers = run.fuel_rows(fuel_category.FIELD, 0, len(run.fuel_latitude))
            category = self.ground.padded(numbers, run.fuel_latitude, run.fuel_longitude)
        return emissions.kind(fields.surface_fuel, fields.canopy_fuel, category)

    @cached_property
    def speed(self) -> Array:
        """(ny, nx) rate of spread (m/s) where the fire goes; 1 elsewhere."""
        row, column = np.nonzero(self.ground.burned > 0.0)
        found = np.ones(self.ground.shape)
        found[row, column] = self.ground.spread(row.astype(np.float64), column.astype(np.float64))
        return found

    @cached_property
    def residence(self) -> Array:
        """(ny, nx) s that flames stand over a spot."""
        return emissions.column("residence")[self.kind]

    @cached_property
    def ash(self) -> Array:
        """(ny, nx) 0..1, how pale what is left is."""
        return emissions.column("ash")[self.kind]


def head(shot: ShotView) -> float:
    """Depth (m) of the flames at the head of the front in a shot; 0 where nothing burns."""
    ground, front = shot.bare_ground, shot.front
    passed = (ground.burned >= 0.5) & (ground.arrival <= shot.frames.last)
    passed &= ground.arrival >= shot.frames.first - _AROUND
    if not passed.any():
        return 0.0
    return float(np.percentile((front.speed * front.residence)[passed], _STRONG))


def scale(shot: ShotView) -> float:
    """Size of what is seen of the front and the scar beside that of a crown fire's, to 1."""
    deep = head(shot)
    return float(np.clip(deep / _WHOLE, _LEAST, 1.0)) if deep else 1.0
