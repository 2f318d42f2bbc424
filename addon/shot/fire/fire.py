"""What burns in a shot, gathered once: flames, lamps, firebrands and smoke take it from here.

The model's heat is shared out exactly. A model cell with flux F gives F x area watts, shared among its fuel
in proportion to the heat of what that consumes at the moment. So the model's heat says how much fuel burns,
and that how much smoke it gives (`emissions`). The front crosses a fuel cell in its size over the rate of
spread; each spot of it loses its fuel as exp(-age / T) from when the front comes (Mandel et al. 2011,
doi 10.5194/gmd-4-591-2011, eq. 3: the ground heat of WRF-SFIRE). So a cell consumes most while the front is
in it and smoulders after.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from firetwin_core import flux
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import areas
from ...run.frame import local_frame
from ..terrain.elevation import Elevation
from . import burning, emissions, heat_release
from .fuel import BURN_OUT_CANOPY, DETAIL, Fuel, gather
from .heat_release import Array, Sources

_FLAMES = emissions.column("residence")
_HEAT, _SMOKE = ([emissions.column(name, part) for part in (0, 1)] for name in ("heat", "smoke"))
_LOOK, _LOOKS = 30.0, 240  # s between two looks at what burns, and how many looks at most
_MOMENTS = 3  # at which a fire's power is looked at, for its column
_AHEAD = 600.0  # s after the last moment: what catches fire in the interval that goes on then


@dataclass(frozen=True)
class Cells:
    """Fuel that catches fire in some time window, n pieces.

    Attributes
    ----------
    arrival
        (n,) s.
    fuel
        (n,) kg/m2 burned, surface and canopy; of a piece of several fuel cells their sum.
    position
        (n, 3) scene metres, on the ground.
    area
        m2 of one fuel cell.
    fire
        What they are part of.
    """

    arrival: Array
    fuel: Array
    position: Array
    area: float
    fire: Fire

    @cached_property
    def wind(self) -> Array:
        """(n, 2) m/s east and north near the ground, at arrival, averaged over the fire's surroundings."""
        return burning.wind_at(self.fire.run, self.arrival, self.fire.surroundings)


class Fire:
    """The fire of a run between two model times: when it comes, and what heat and smoke it gives.

    Parameters
    ----------
    first, last
        Model times of the shot, s.
    before
        s before `first` from which on what has burned is asked for, smoke for instance.
    relief
        Heights of the ground; None: the run's.
    arrival
        (fy, fx) s, when the front passes the middle of each fuel cell; None: as the run says.
    detail
        Fuel cells nearer than this burn as one, m.
    """

    def __init__(
        self,
        run: Run,
        first: float,
        last: float,
        before: float = 0.0,
        relief: Elevation | None = None,
        arrival: Array | None = None,
        detail: float = DETAIL,
    ) -> None:
        self.relief = relief or Elevation(run)
        self.run, self.first, self.last, self.before, self.detail = run, first, last, before, detail
        self.frame = local_frame(run)
        if arrival is not None:
            self.arrival = arrival

    @cached_property
    def arrival(self) -> Array:
        """(fy, fx) s, when the front passes the middle of each fuel cell; NaN where never."""
        return self.run.fuel_arrival_time()

    @cached_property
    def flux(self) -> flux.Interpolator:
        """The heat flux at any time."""
        return flux.Interpolator(self.run)

    @cached_property
    def cell_area(self) -> Array:
        """(ny * nx,) m2 of each cell of the model grid."""
        run = self.run
        if min(run.elevation.shape) == 1:
            return np.full(run.elevation.size, burning.model_cell_area(run))
        return areas.cell_areas(run.latitude, run.longitude).ravel()

    @cached_property
    def fuel(self) -> Fuel:
        """What burns in the shot, or has burned not long before it."""
        known = None if self.run.has("fuel_arrival_time") else self.arrival
        return gather(self.run, known, self.first, self.last + _AHEAD, self.before, self.relief, self.detail)

    def sources(self, time: float) -> Sources:
        """Everything that gives heat at `time` (s): together each model cell's flux times its area.

        A model cell without burning fuel gives its heat from its centre. The cost is that of what burns.
        """
        fuel = self.fuel
        hot, found = self.flux.burning(time)
        found = np.maximum(np.nan_to_num(found.astype(np.float64)), 0.0)
        hot, found = hot[found > 0.0], found[found > 0.0]
        heat_of = found * self.cell_area[hot]
        came = int(np.searchsorted(fuel.begin, time))
        gone = int(np.searchsorted(fuel.begin, time - self._longest))
        place = np.searchsorted(hot, fuel.cell[gone:came])
        in_hot = place < len(hot)
        in_hot[in_hot] = hot[place[in_hot]] == fuel.cell[gone:came][in_hot]
        here = np.flatnonzero(in_hot & (fuel.over[gone:came] > time))
        lit, place = gone + here, place[here]
        age, crossing = time - fuel.begin[lit], fuel.crossing[lit]
        kind = fuel.kind[lit]
        parts = [
            (fuel.surface[lit], kind, heat_release.consumed(age, crossing, fuel.slow[lit], _FLAMES[kind])),
            (fuel.canopy[lit], emissions.CROWN, heat_release.consumed(age, crossing, BURN_OUT_CANOPY)),
        ]
        rate, flaming, smoke = np.zeros((3, len(lit)))
        for load, of, (lost, in_flames) in parts:
            burned = load * in_flames, load * (lost - in_flames)
            flaming += burned[0] * _HEAT[0][of]
            rate += burned[0] * _HEAT[0][of] + burned[1] * _HEAT[1][of]
            smoke += burned[0] * _SMOKE[0][of] + burned[1] * _SMOKE[1][of]
        total = np.bincount(place, rate, len(hot))
        share = heat_of[place] / np.where(total > 0.0, total, 1.0)[place]
        alone = np.flatnonzero(total <= 0.0)
        return Sources(
            np.concatenate([fuel.position[lit], self._centres(hot[alone])]),
            np.concatenate([rate * share, heat_of[alone]]),
            np.concatenate([flaming * share, heat_of[alone]]),
            np.concatenate([smoke * share, emissions.PLAIN * heat_of[alone]]),
            np.concatenate([fuel.cell[lit], hot[alone]]),
            np.concatenate([fuel.fuel_cell[lit], np.full(len(alone), -1)]),
        )

    def cells(self, first: float, last: float) -> Cells:
        """Fuel that catches fire between `first` and `last` (s), by its place on the grid."""
        fuel = self.fuel
        chosen = np.flatnonzero((fuel.arrival >= first) & (fuel.arrival <= last))
        chosen = chosen[np.argsort(fuel.fuel_cell[chosen], kind="stable")]
        arrival = fuel.arrival[chosen]
        return Cells(
            arrival,
            fuel.surface[chosen] + fuel.canopy[chosen],
            fuel.position[chosen],
            burning.cell_area(self.run),
            self,
        )

    @cached_property
    def residence(self) -> Array:
        """(fy, fx) s that flames stand over each fuel cell."""
        run = self.run
        return _FLAMES[emissions.of_run(run)]

    @cached_property
    def smoke(self) -> emissions.Mix:
        """What the smoke of all this fuel is made of: as it would burn out."""
        fuel, crown = self.fuel, emissions.CROWN
        made, heat_of = np.zeros(len(emissions.KINDS)), 0.0
        parts = ((fuel.surface, fuel.kind, fuel.slow), (fuel.canopy, crown, np.float64(BURN_OUT_CANOPY)))
        for load, of, slow in parts:
            flames = -np.expm1(-_FLAMES[of] / slow)
            burned = load * flames, load * (1.0 - flames)
            smoke = sum(mass * per_kg[of] for mass, per_kg in zip(burned, _SMOKE, strict=True))
            heat_of += float(
                sum((mass * per_kg[of]).sum() for mass, per_kg in zip(burned, _HEAT, strict=True))
            )
            made += np.bincount(np.broadcast_to(of, load.shape), smoke, len(made))
        power = max(self.sources(time).power.sum() for time in np.linspace(self.first, self.last, _MOMENTS))
        return emissions.mix(made, heat_of, float(power))

    def smoke_made(self, first: float, last: float) -> float:
        """Smoke (kg) given off between two model times (s), by the trapezoidal rule."""
        step = max(_LOOK, (last - first) / _LOOKS)
        times = np.linspace(first, last, max(1, math.ceil((last - first) / step)) + 1)
        rate = np.array([self.sources(float(time)).smoke.sum() for time in times])
        return float(np.sum(0.5 * (rate[1:] + rate[:-1]) * np.diff(times)))

    @cached_property
    def surroundings(self) -> tuple[slice, slice]:
        """Rows and columns of the model grid round everything that burns in the run."""
        return burning.surroundings(self.run, self.arrival)

    @cached_property
    def _longest(self) -> float:
        """Seconds that a piece burns at most."""
        return float(np.max(self.fuel.over - self.fuel.begin, initial=0.0))

    def _centres(self, cell: NDArray[np.int64]) -> Array:
        """Scene points (n, 3) of the centres of model cells."""
        run = self.run
        row, column = np.divmod(cell, len(run.longitude))
        height = np.nan_to_num(self.relief.coarse[row, column].astype(np.float64))
        return self.frame.forward(run.latitude[row], run.longitude[column], height)
