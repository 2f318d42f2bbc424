"""Fire of a shot: burning fuel and heat release for flames, lights, firebrands and smoke.

The model's heat is conserved. A model cell with heat flux F releases F x area watts. They are shared among
its fuel in proportion to the heat that each piece releases at that time. The model's heat thus decides how
much fuel burns, and the fuel burned decides the smoke (`emissions`). The front crosses a fuel cell in the
cell's size over the rate of spread. Each spot loses its fuel as exp(-age / T) after the front arrives (Mandel
et al. 2011, doi 10.5194/gmd-4-591-2011, eq. 3: the ground heat of WRF-SFIRE). A cell therefore consumes most
while the front crosses it and smoulders later.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from firetwin_core import flux
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import burning
from ...run.frame import local_frame
from ..terrain.elevation import Elevation
from . import emissions, heat_release, long_burning
from .fuel import BURN_OUT_CANOPY, DETAIL, Fuel, gather
from .heat_release import Array, Sources

_FLAMES = emissions.column("residence")
_HEAT, _SMOKE = ([emissions.column(name, part) for part in (0, 1)] for name in ("heat", "smoke"))
_LOOK, _MAX_SAMPLES = 2.0, 2000  # s between samples of the smoke, and samples of the shot at most
_LINEAR = 0.5, 2.0  # limits of the factor to a linear course of the total power
_MOMENTS = 3  # times at which the fire's power is sampled for its column
_AHEAD = 600.0  # s after the last frame; includes fuel that ignites in the interval under way then


@dataclass(frozen=True)
class Cells:
    """Fuel that ignites within a time window, n pieces.

    Attributes
    ----------
    arrival
        (n,) arrival time, s.
    fuel
        (n,) burned surface and canopy fuel, kg/m2; summed over the fuel cells of a piece.
    position
        (n, 3) scene metres, on the ground.
    area
        m2 of one fuel cell.
    fire
        The fire to which they belong.
    """

    arrival: Array
    fuel: Array
    position: Array
    area: float
    fire: Fire

    @cached_property
    def wind(self) -> Array:
        """Near-surface wind (n, 2), m/s east and north, at arrival time, averaged around the fire."""
        return burning.wind_at(self.fire.run, self.arrival, self.fire.surroundings)


class Fire:
    """Fire of a run between two model times: arrival times, heat release and smoke.

    Parameters
    ----------
    first, last
        Model times of the first and last frame, s.
    before
        Time before `first` for which burned fuel is included, s, for instance for smoke.
    relief
        Terrain elevation; None: the run's.
    arrival
        Arrival time (fy, fx), s, at the centre of each fuel cell; None: the run's.
    detail
        Distance within which fuel cells are merged, m.
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
        self._powers: dict[int, float] = {}
        if arrival is not None:
            self.arrival = arrival

    @cached_property
    def arrival(self) -> Array:
        """Arrival time (fy, fx), s, at the centre of each fuel cell; NaN where it never burns."""
        return self.run.fuel_arrival_time()

    @cached_property
    def flux(self) -> flux.Interpolator:
        """Interpolator of the heat flux in time."""
        return flux.Interpolator(self.run)

    @cached_property
    def cell_area(self) -> Array:
        """Area (ny * nx,) of each model cell, m2."""
        return burning.model_cell_areas(self.run).ravel()

    @cached_property
    def fuel(self) -> Fuel:
        """Fuel that burns in the shot or burned shortly before it."""
        known = None if self.run.has("fuel_arrival_time") else self.arrival
        return gather(self.run, known, self.first, self.last + _AHEAD, self.before, self.relief, self.detail)

    def sources(self, time: float) -> Sources:
        """Heat sources at `time` (s); at a model time their power sums to flux times area in each model cell.

        Between model times the total power is linear, so that its integral is the heat of the run. A model
        cell without burning fuel releases its heat at its centre. The cost scales with the burning fuel.
        """
        fuel = self.fuel
        hot, heat_of = self._heat(time)
        heat_of = heat_of * self._to_linear(time, float(heat_of.sum()))
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

    def luminous(self, sources: Sources) -> Sources:
        """Compute luminous power of `sources`; no model cell shines more than a front of `CROWN_FIRE_FLUX`.

        A fiercer fire has larger flames, but not hotter ones: a flame at 1400 K emits at most 218 kW/m2.
        """
        lit = sources.luminous()
        total = np.bincount(lit.cell, lit.power, len(self.cell_area))
        most = burning.CROWN_FIRE_FLUX * self.cell_area
        if not np.any(total > most):
            return lit
        part = np.minimum(most / np.maximum(total, most), 1.0)[lit.cell]
        return replace(lit, power=part * lit.power, flaming=part * lit.flaming)

    def cells(self, first: float, last: float) -> Cells:
        """Fuel that ignites between `first` and `last` (s), in grid order."""
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
        """Residence time of flames (fy, fx), s; longer where the run's heat flux stays intense."""
        of_fuel, intense = _FLAMES[emissions.of_run(self.run)], long_burning.duration(self.run)
        return of_fuel if intense is None else np.maximum(of_fuel, intense)

    @cached_property
    def smoke(self) -> emissions.Mix:
        """Composition of the smoke of all this fuel at complete burn-out."""
        fuel, crown = self.fuel, emissions.CROWN
        smoke_of_kind, heat_of = np.zeros(len(emissions.KINDS)), 0.0
        parts = ((fuel.surface, fuel.kind, fuel.slow), (fuel.canopy, crown, np.float64(BURN_OUT_CANOPY)))
        for load, of, slow in parts:
            flames = -np.expm1(-_FLAMES[of] / slow)
            burned = load * flames, load * (1.0 - flames)
            smoke = sum(mass * per_kg[of] for mass, per_kg in zip(burned, _SMOKE, strict=True))
            heat_of += float(
                sum((mass * per_kg[of]).sum() for mass, per_kg in zip(burned, _HEAT, strict=True))
            )
            smoke_of_kind += np.bincount(np.broadcast_to(of, load.shape), smoke, len(smoke_of_kind))
        power = max(self.sources(time).power.sum() for time in np.linspace(self.first, self.last, _MOMENTS))
        return emissions.mix(smoke_of_kind, heat_of, float(power))

    def smoke_made(self, first: float, last: float) -> float:
        """Smoke emitted between two model times (s) of the shot or of the time before it, kg.

        Parts of a span add up to the span: the rate is constant in each of the same intervals.
        """
        edges = self._intervals
        within = np.diff(np.clip(edges, first, last))
        for number in np.flatnonzero((within > 0.0) & np.isnan(self._smoke_rates)):
            middle = float(edges[number : number + 2].mean())
            self._smoke_rates[number] = self.sources(middle).smoke.sum()
        return float(within[within > 0.0] @ self._smoke_rates[within > 0.0])

    @cached_property
    def _intervals(self) -> Array:
        """Borders (n + 1,) of the intervals of `smoke_made`, s; the first frame is one of them."""
        step = max(_LOOK, (self.last - self.first) / _MAX_SAMPLES)
        before, during = (math.ceil(span / step - 1e-9) for span in (self.before, self.last - self.first))
        return np.concatenate(
            [
                np.linspace(self.first - self.before, self.first, before, endpoint=False),
                np.linspace(self.first, self.last, during + 1),
            ]
        )

    @cached_property
    def _smoke_rates(self) -> Array:
        """Smoke (n,) of the intervals, kg/s; NaN until it is needed."""
        return np.full(len(self._intervals) - 1, np.nan)

    @cached_property
    def surroundings(self) -> tuple[slice, slice]:
        """Rows and columns of the model grid around all cells that burn in the run."""
        return burning.surroundings(self.run, self.arrival)

    def _heat(self, time: float) -> tuple[NDArray[np.int64], Array]:
        """Return the burning model cells (n,) at a time (s), and their heat release rate (n,), W."""
        hot, heat_flux = self.flux.burning(time)
        heat_flux = np.maximum(np.nan_to_num(heat_flux.astype(np.float64)), 0.0)
        hot, heat_flux = hot[heat_flux > 0.0], heat_flux[heat_flux > 0.0]
        return hot, heat_flux * self.cell_area[hot]

    def _to_linear(self, time: float, power: float) -> float:
        """Return the factor from the interpolated total power (W) to the linear course between model times.

        Flux is interpolated for an even course of F^1.5, which has more heat in cells that ignite and burn
        out between a few model times.
        """
        times = np.asarray(self.run.times)
        if len(times) < 2 or not power > 0.0 or not times[0] <= time <= times[-1]:
            return 1.0
        after = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1))
        share = (time - times[after - 1]) / (times[after] - times[after - 1])
        linear = (1.0 - share) * self._power_at(after - 1) + share * self._power_at(after)
        return float(np.clip(linear / power, *_LINEAR))

    def _power_at(self, index: int) -> float:
        """Return the heat release rate of the run at a model time, W."""
        if index not in self._powers:
            self._powers[index] = float(self._heat(float(self.run.times[index]))[1].sum())
        return self._powers[index]

    @cached_property
    def _longest(self) -> float:
        """Longest burning time of a piece, s."""
        return float(np.max(self.fuel.over - self.fuel.begin, initial=0.0))

    def _centres(self, cell: NDArray[np.int64]) -> Array:
        """Centres of model cells (n, 3), scene points on the ground."""
        run = self.run
        row, column = np.divmod(cell, len(run.longitude))
        height = np.nan_to_num(self.relief.coarse[row, column].astype(np.float64))
        return self.frame.forward(run.latitude[row], run.longitude[column], height)
