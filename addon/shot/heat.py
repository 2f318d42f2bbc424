"""The model's heat shared out exactly among what burns, as sources of light and embers; without Blender.

A model cell with flux F gives F x area watts, shared among its fuel cells in proportion to the fuel that they
consume at that moment. The front crosses a fuel cell in its size over the rate of spread; each spot of it
loses its fuel as exp(-age / T) from when the front comes (Mandel et al. 2011, doi 10.5194/gmd-4-591-2011,
eq. 3: the ground heat of WRF-SFIRE). So a cell consumes most while the front is in it and smoulders after.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from firetwin_core import flux
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ..run.frame import local_frame
from . import burning

BURN_OUT_CANOPY = 90.0  # s, foliage and twigs (assumed)
# s and s for each kg/m2: brush of 0.3 kg/m2 takes 210 s and timber litter of 3 kg/m2 1020 s, as in WRF-SFIRE
# (T = weight / 0.8514 with its weights 180 and 900).
BURN_OUT_SURFACE = (120.0, 300.0)
FLAMING = 120.0  # s that a spot flames after the front reached it (assumed); later it smoulders
SMOULDER_LIGHT = 0.1  # light of a smouldering watt over that of a flaming one (assumed)
_CROSSING = (60.0, 3600.0)  # s
_OVER = 14.0  # burn-out times after which what is left, e^-14, is not worth a look

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sources:
    """Heat of one moment, n sources.

    Attributes
    ----------
    position
        (n, 3) scene metres, on the ground.
    power
        (n,) W.
    flaming
        (n,) W, that part of it which comes from where flames stand.
    cell
        (n,) flat index on the model grid; -1 where sources of several cells were merged.
    fuel_cell
        (n,) flat index on the fuel grid; -1 for the centre of a model cell and for merged sources.
    """

    position: Array
    power: Array
    flaming: Array
    cell: NDArray[np.int64]
    fuel_cell: NDArray[np.int64]

    def take(self, chosen: NDArray) -> Sources:
        """Some of the sources."""
        return Sources(*(getattr(self, field.name)[chosen] for field in fields(self)))

    def luminous(self) -> Sources:
        """The same with the power that counts as light: of flames all, of smouldering fuel little."""
        light = self.flaming + SMOULDER_LIGHT * (self.power - self.flaming)
        return replace(self, power=light, flaming=np.minimum(self.flaming, light))


def consumed(age: ArrayLike, crossing: ArrayLike, burn_out: ArrayLike) -> tuple[Array, Array]:
    """Part of a cell's fuel lost per second `age` s after the front came in, 1/s, and its flaming part.

    The mean of exp(-a / T) / T over the ages a of the cell's spots, which lie evenly between age - crossing
    and age; spots younger than FLAMING flame.
    """
    age, crossing, burn_out = (np.asarray(v, np.float64) for v in (age, crossing, burn_out))
    youngest = np.maximum(age - crossing, 0.0)
    flame_end = np.clip(FLAMING, youngest, np.maximum(age, youngest))
    left = np.exp(-youngest / burn_out)
    scale = np.where(age > 0.0, 1.0 / crossing, 0.0)
    total = (left - np.exp(-np.maximum(age, 0.0) / burn_out)) * scale
    return total, np.minimum((left - np.exp(-flame_end / burn_out)) * scale, total)


class Heat:
    """A run's heat between the model times `first` and `last` (s), shared out for any moment."""

    def __init__(self, run: Run, first: float = -np.inf, last: float = np.inf) -> None:
        self.run = run
        frame = local_frame(run)
        self.area = burning.model_cell_area(run)
        surface, canopy = (
            np.nan_to_num(field.astype(np.float64)).ravel() for field in (run.surface_fuel, run.canopy_fuel)
        )
        arrival = run.fuel_arrival_time().astype(np.float64)
        crossing = _crossing(arrival)
        begin = arrival - 0.5 * crossing  # the arrival time is that of the cell's centre
        slow = BURN_OUT_SURFACE[0] + BURN_OUT_SURFACE[1] * surface
        over = begin.ravel() + crossing.ravel() + _OVER * np.maximum(slow, BURN_OUT_CANOPY)
        with np.errstate(invalid="ignore"):
            burns = (begin.ravel() < last) & (over > first) & (surface + canopy > 0.0)
        chosen = np.flatnonzero(burns)
        self.fuel_cell = chosen[np.argsort(begin.ravel()[chosen], kind="stable")]
        self.begin, self.crossing, self.over = (v.ravel()[self.fuel_cell] for v in (begin, crossing, over))
        self.surface, self.canopy, self.slow = (v[self.fuel_cell] for v in (surface, canopy, slow))
        self._rows = _nearest(run.latitude, run.fuel_latitude)
        self._columns = _nearest(run.longitude, run.fuel_longitude)
        row, column = np.divmod(self.fuel_cell, arrival.shape[1])
        self.cell = self._rows[row] * len(run.longitude) + self._columns[column]
        height = np.nan_to_num(run.fuel_elevation.astype(np.float64))
        self.position = frame.forward_grid(run.fuel_latitude, run.fuel_longitude, height).reshape(-1, 3)[
            self.fuel_cell
        ]
        height = np.nan_to_num(run.elevation.astype(np.float64))
        self.centre = frame.forward_grid(run.latitude, run.longitude, height).reshape(-1, 3)

    def cells(self, time: float) -> Array:
        """Heat of each model cell (ny * nx,) at `time`, W: its flux times its area."""
        times = self.run.times
        near = int(np.argmin(np.abs(times - time)))
        found = self.run.heat_flux(near) if times[near] == time else flux.at_time(self.run, time)
        return np.maximum(np.nan_to_num(found.astype(np.float64)), 0.0).ravel() * self.area

    def sources(self, time: float) -> Sources:
        """Everything that gives heat at `time`; a cell without burning fuel gives it from its centre."""
        heat = self.cells(time)
        came = np.searchsorted(self.begin, time)
        lit = np.flatnonzero((self.over[:came] > time) & (heat[self.cell[:came]] > 0.0))
        age, crossing, cell = time - self.begin[lit], self.crossing[lit], self.cell[lit]
        parts = [
            (self.surface[lit], consumed(age, crossing, self.slow[lit])),
            (self.canopy[lit], consumed(age, crossing, BURN_OUT_CANOPY)),
        ]
        rate = sum(fuel * all_of_it for fuel, (all_of_it, _) in parts)
        flaming = sum(fuel * part for fuel, (_, part) in parts)
        total = np.bincount(cell, rate, len(heat))
        share = heat[cell] / np.where(total > 0.0, total, 1.0)[cell]
        alone = np.flatnonzero((heat > 0.0) & (total <= 0.0))
        return Sources(
            np.concatenate([self.position[lit], self.centre[alone]]),
            np.concatenate([rate * share, heat[alone]]),
            np.concatenate([flaming * share, heat[alone]]),
            np.concatenate([cell, alone]),
            np.concatenate([self.fuel_cell[lit], np.full(len(alone), -1)]),
        )


def lights(sources: Sources, block: float = 300.0, count: int = 400) -> Sources:
    """Sources merged into at most `count`, without losing heat and without jumps from moment to moment.

    Each is shared between the four nearest nodes of a fixed grid, `block` metres apart, by bilinear weights.
    Half of `count` is for the strongest nodes; what the others have goes to a grid twice as coarse, half of
    what is left of `count` is for that, and so on. A node becomes one of the strongest gradually, between
    the power of the strongest that is not and twice that, so no light comes or goes at once.
    """
    kept: list[Sources] = []
    rest = sources.take(np.flatnonzero(sources.power > 0.0))
    while count > 0 and len(rest.power):
        nodes = _on_grid(rest, block) if count > 1 else _gathered(rest, np.zeros(len(rest.power), np.int64))
        room = (count + 1) // 2
        if len(nodes.power) <= room:
            kept.append(nodes)
            break
        edge = float(np.partition(nodes.power, -room - 1)[-room - 1])
        part = np.clip(nodes.power / edge - 1.0, 0.0, 1.0)
        strong, weak = np.flatnonzero(part > 0.0), np.flatnonzero(part < 1.0)
        kept.append(_gathered(nodes, np.arange(len(strong)), part[strong], strong))
        rest = _gathered(nodes, np.arange(len(weak)), 1.0 - part[weak], weak)
        count, block = count - room, 2.0 * block
    if not kept:
        return sources.take(np.empty(0, np.int64))
    return Sources(*(np.concatenate([getattr(k, field.name) for k in kept]) for field in fields(Sources)))


def _on_grid(sources: Sources, block: float) -> Sources:
    """Sources shared between the nodes of a grid, `block` metres apart, by bilinear weights."""
    low = np.floor(sources.position[:, :2] / block).astype(np.int64)
    part = sources.position[:, :2] / block - low
    corners = [(east, north) for east in (0, 1) for north in (0, 1)]
    weight = [np.abs(1 - e - part[:, 0]) * np.abs(1 - n - part[:, 1]) for e, n in corners]
    key = np.concatenate([low + np.array(corner) for corner in corners]) @ np.array([1 << 32, 1])
    _, group = np.unique(key, return_inverse=True)
    return _gathered(sources, group, np.concatenate(weight), np.tile(np.arange(len(low)), 4))


def _gathered(
    sources: Sources,
    group: NDArray[np.int64],
    weight: Array | float = 1.0,
    member: NDArray | slice = slice(None),
) -> Sources:
    """Sums of parts `weight` of the sources `member` in each `group`, at their centres of power."""
    power = sources.power[member] * weight
    total = np.bincount(group, power)
    place = np.stack([np.bincount(group, power * sources.position[member, k]) for k in range(3)], axis=-1)
    some = total > 0.0
    nowhere = np.full(int(some.sum()), -1)
    return Sources(
        place[some] / total[some, None],
        total[some],
        np.bincount(group, sources.flaming[member] * weight)[some],
        nowhere,
        nowhere,
    )


def _crossing(arrival: Array) -> Array:
    """Seconds that the front takes to cross each fuel cell: the cell's size times the slope of arrival.

    Of the two one-sided differences the smaller: a jump to another fire's arrival is no slow front.
    """
    padded = np.pad(arrival, 1, constant_values=np.nan)
    steps = []
    for axis in (0, 1):
        gaps = [np.abs(padded - np.roll(padded, shift, axis))[1:-1, 1:-1] for shift in (1, -1)]
        steps.append(np.nan_to_num(np.fmin(*gaps)))
    return np.clip(np.hypot(*steps), *_CROSSING)


def _nearest(axis: ArrayLike, values: ArrayLike) -> NDArray[np.int64]:
    """Index of the axis value nearest to each value; the axis ascends or descends."""
    axis = np.asarray(axis, np.float64)
    order = np.argsort(axis, kind="stable")
    edges = 0.5 * (axis[order][1:] + axis[order][:-1])
    return order[np.searchsorted(edges, values)]
