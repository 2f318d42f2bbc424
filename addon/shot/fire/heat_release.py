"""Heat release: sources of heat, light and smoke at one time, and their merging. Needs no Blender."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import emissions

FLAMING = emissions.KINDS[emissions.LITTER].residence
"""Residence time of flames in timber, s; it smoulders later."""
SMOULDER_LIGHT = 0.1  # luminous efficiency of smouldering relative to flaming heat (assumed)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sources:
    """Heat sources at one time, n of them.

    Attributes
    ----------
    position
        (n, 3) scene metres, on the ground.
    power
        (n,) heat release rate, W.
    flaming
        (n,) heat release rate of the flaming part, W.
    smoke
        (n,) emission rate of PM2.5, kg/s.
    cell
        (n,) flat index on the model grid; -1 for sources merged across cells.
    fuel_cell
        (n,) flat index on the fuel grid, of the first cell of a source; -1 for the centre of a model cell and
        for merged sources.
    """

    position: Array
    power: Array
    flaming: Array
    smoke: Array
    cell: NDArray[np.int64]
    fuel_cell: NDArray[np.int64]

    def take(self, chosen: NDArray) -> Sources:
        """Select sources by index or mask."""
        return Sources(*(getattr(self, field.name)[chosen] for field in fields(self)))

    def luminous(self) -> Sources:
        """Return sources with luminous power: all flaming heat, smouldering heat times `SMOULDER_LIGHT`."""
        light = self.flaming + SMOULDER_LIGHT * (self.power - self.flaming)
        return replace(self, power=light, flaming=np.minimum(self.flaming, light))


def consumed(
    age: ArrayLike, crossing: ArrayLike, burn_out: ArrayLike, flames: ArrayLike = FLAMING
) -> tuple[Array, Array]:
    """Fuel consumption rate of a cell, 1/s, at `age` s after the front entered: total and flaming part.

    The mean of exp(-a / T) / T over the ages a of the cell's spots, uniform from age - crossing to age. Spots
    younger than `flames` (s) flame.
    """
    age, crossing, burn_out = (np.asarray(v, np.float64) for v in (age, crossing, burn_out))
    youngest = np.maximum(age - crossing, 0.0)
    flame_end = np.clip(flames, youngest, np.maximum(age, youngest))
    left = np.exp(-youngest / burn_out)
    scale = np.where(age > 0.0, 1.0 / crossing, 0.0)
    total = (left - np.exp(-np.maximum(age, 0.0) / burn_out)) * scale
    return total, np.minimum((left - np.exp(-flame_end / burn_out)) * scale, total)


def lights(sources: Sources, block: float = 300.0, count: int = 400) -> Sources:
    """Merge sources into at most `count` lights, with heat conserved and without temporal popping.

    Each source is shared between the four nearest nodes of a fixed grid, `block` metres apart, by bilinear
    weights. The strongest nodes take half of `count`. The rest goes to a grid twice as coarse with half of
    the remaining `count`, and so on. A node is promoted gradually: its strong part rises from 0 at the power
    of the strongest excluded node to 1 at twice that power.
    """
    merged: list[Sources] = []
    rest = sources.take(np.flatnonzero(sources.power > 0.0))
    while count > 0 and len(rest.power):
        nodes = (
            _to_nodes(rest, block) if count > 1 else _sum_groups(rest, np.zeros(len(rest.power), np.int64))
        )
        room = (count + 1) // 2
        if len(nodes.power) <= room:
            merged.append(nodes)
            break
        edge = float(np.partition(nodes.power, -room - 1)[-room - 1])
        part = np.clip(nodes.power / edge - 1.0, 0.0, 1.0)
        strong, weak = np.flatnonzero(part > 0.0), np.flatnonzero(part < 1.0)
        merged.append(_sum_groups(nodes, np.arange(len(strong)), part[strong], strong))
        rest = _sum_groups(nodes, np.arange(len(weak)), 1.0 - part[weak], weak)
        count, block = count - room, 2.0 * block
    if not merged:
        return sources.take(np.empty(0, np.int64))
    return Sources(*(np.concatenate([getattr(k, field.name) for k in merged]) for field in fields(Sources)))


def _to_nodes(sources: Sources, block: float) -> Sources:
    """Distribute sources to the nodes of a grid, `block` metres apart, by bilinear weights."""
    low = np.floor(sources.position[:, :2] / block).astype(np.int64)
    part = sources.position[:, :2] / block - low
    corners = [(east, north) for east in (0, 1) for north in (0, 1)]
    weight = [np.abs(1 - e - part[:, 0]) * np.abs(1 - n - part[:, 1]) for e, n in corners]
    key = np.concatenate([low + np.array(corner) for corner in corners]) @ np.array([1 << 32, 1])
    _, group = np.unique(key, return_inverse=True)
    return _sum_groups(sources, group, np.concatenate(weight), np.tile(np.arange(len(low)), 4))


def _sum_groups(
    sources: Sources,
    group: NDArray[np.int64],
    weight: Array | float = 1.0,
    member: NDArray | slice = slice(None),
) -> Sources:
    """Sum sources in each `group`: fractions `weight` of the sources `member`, at their centres of power."""

    def total_of(values: Array) -> Array:
        return np.bincount(group, values).astype(np.float64, copy=False)

    power = sources.power[member] * weight
    total = total_of(power)
    place = np.stack([total_of(power * sources.position[member, k]) for k in range(3)], axis=-1)
    some = total > 0.0
    nowhere = np.full(int(some.sum()), -1)
    return Sources(
        place[some] / total[some, None],
        total[some],
        total_of(sources.flaming[member] * weight)[some],
        total_of(sources.smoke[member] * weight)[some],
        nowhere,
        nowhere,
    )
