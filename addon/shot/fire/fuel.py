"""Burning fuel: fuel cells that burn within a time window, merged into pieces. Needs no Blender."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import blocks, burned_fraction, burning, fuel_category
from ...run.frame import local_frame
from ..terrain.elevation import Elevation
from . import emissions

BURN_OUT_CANOPY = emissions.KINDS[emissions.CROWN].burn_out[0]  # s, foliage and twigs (assumed)
_BURN_OUTS = 14.0  # burn-out times after which the rest, e^-14, is neglected
DETAIL = 75.0  # m, merging distance of fuel cells in a fire of 15 km; it bounds the pieces of a finer run

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class Fuel:
    """Burning fuel, n pieces in order of ignition: a fuel cell, or several merged within one model cell.

    Attributes
    ----------
    fuel_cell, cell
        (n,) flat index on the fuel grid (of a piece's first cell), and on the model grid.
    arrival
        (n,) arrival time at the centre, s.
    begin, crossing, over
        (n,) ignition time, crossing time of the front, and time of burn-out, s.
    surface, canopy
        (n,) fuel load per fuel-cell area, kg/m2, summed over the cells of a piece. If the run has a burned
        fraction, only that part counts.
    kind
        (n,) kind of the surface fuel, of `emissions.KINDS`; one for each piece.
    slow
        (n,) burn-out time of the surface fuel, s.
    position
        (n, 3) scene metres, on the ground.
    """

    fuel_cell: Index
    cell: Index
    arrival: Array
    begin: Array
    crossing: Array
    over: Array
    surface: Array
    canopy: Array
    kind: NDArray[np.int8]
    slow: Array
    position: Array

    def take(self, chosen: NDArray) -> Fuel:
        """Select pieces by index or mask."""
        return Fuel(*(getattr(self, field.name)[chosen] for field in fields(self)))


def gather(
    run: Run,
    measured_arrival: Array | None,
    first: float,
    last: float,
    before: float,
    relief: Elevation | None = None,
    detail: float = DETAIL,
) -> Fuel:
    """Gather fuel that burns between `first` and `last` (model time, s) or ignited up to `before` s earlier.

    The run's fields are read in blocks of rows, and only where something burns.

    Parameters
    ----------
    measured_arrival
        Arrival times (fy, fx), s, NaN where never; None: the run's.
    relief
        Terrain elevation; None: the run's.
    detail
        Merging distance of fuel cells, m.
    """
    heights = relief or Elevation(run)
    arrival, share = blocks.arrival(run, measured_arrival), None
    if run.has(burned_fraction.FIELD):
        share = burned_fraction.at(run, float(run.times[-1]))
    window = first, last, before
    parts = [_of_rows(run, heights, arrival, share, rows, window) for rows in blocks.rows(run)]
    every = Fuel(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Fuel)))
    row, column = np.divmod(every.fuel_cell, len(run.fuel_longitude))
    pieces = _merge(run, every, row, column, detail)
    return pieces.take(np.argsort(pieces.begin, kind="stable"))


def _of_rows(
    run: Run,
    heights: Elevation,
    arrival: Callable[[int, int], NDArray],
    share: NDArray | None,
    rows: tuple[int, int],
    window: tuple[float, float, float],
) -> Fuel:
    """Burning fuel of a block of rows, one piece for each cell."""
    (top, end), (first, last, before) = rows, window
    # a halo row on each side for gradients
    edge, beyond = max(top - 2, 0), min(end + 2, len(run.fuel_latitude))
    time = arrival(edge, beyond)
    if share is not None:
        time = _with_partial_cells(time, share[edge:beyond])
    inner = time[top - edge : end - edge]
    came = inner < last + burning.CROSSING[1]
    if came.any():  # the slowest fuel of these rows bounds the burning time
        most = np.fmax.reduce(run.fuel_rows("surface_fuel", top, end), axis=None, initial=0.0)
        longest = burning.CROSSING[1] + _BURN_OUTS * max(float(_longest_burn_out(most)), BURN_OUT_CANOPY)
        came &= inner > first - max(longest, before)
    row, column = np.divmod(np.flatnonzero(came), inner.shape[1])
    surface = np.nan_to_num(_values_at(partial(run.fuel_rows, "surface_fuel"), top, row, column))
    burning_out = np.maximum(_longest_burn_out(surface), BURN_OUT_CANOPY)
    near = inner[row, column] > first - np.maximum(burning.CROSSING[1] + _BURN_OUTS * burning_out, before)
    row, column, surface = row[near], column[near], surface[near]
    canopy = np.nan_to_num(_values_at(partial(run.fuel_rows, "canopy_fuel"), top, row, column))
    category = None
    if run.has(fuel_category.FIELD):
        category = _values_at(partial(run.fuel_rows, fuel_category.FIELD), top, row, column)
    kind = emissions.kind(surface, canopy, category)
    slow = emissions.burn_out(surface, kind)
    came = inner[row, column].astype(np.float64)
    least = burning.least_crossing(float(np.sqrt(burning.cell_area(run))))
    crossing = burning.crossing(time, row + top - edge, column, least)
    begin = came - 0.5 * crossing  # arrival time is defined at the cell's centre
    over = begin + crossing + _BURN_OUTS * np.maximum(slow, BURN_OUT_CANOPY)
    recent = (over > first) | (came >= first - before)
    burns = np.flatnonzero((surface + canopy > 0.0) & (begin < last) & recent)
    row, column = row[burns], column[burns]
    part = 1.0 if share is None else share[row + top, column].astype(np.float64)
    height = np.nan_to_num(_values_at(heights.rows, top, row, column))
    place = run.fuel_latitude[row + top], run.fuel_longitude[column]
    return Fuel(
        (row + top) * len(run.fuel_longitude) + column,
        _model_cell(run, row + top, column),
        came[burns],
        begin[burns],
        crossing[burns],
        over[burns],
        surface[burns] * part,
        canopy[burns] * part,
        kind[burns],
        slow[burns],
        local_frame(run).forward(*place, height),
    )


def _with_partial_cells(time: NDArray, share: NDArray) -> NDArray:
    """Arrival times, extended to cells that burn in part although the front never reaches their centre.

    Such a cell takes the latest arrival time of its neighbours; without one it stays NaN.
    """
    padded, latest = np.pad(time, 1, constant_values=np.nan), np.full_like(time, np.nan)
    rows, columns = time.shape
    for y in range(3):
        for x in range(3):
            latest = np.fmax(latest, padded[y : y + rows, x : x + columns])
    return np.where(np.isnan(time) & (share > 0.0), latest, time)


def _values_at(rows: Callable[[int, int], NDArray], top: int, row: Index, column: Index) -> Array:
    """Values of the fuel grid at rows (counted from `top`) and columns, read by `rows`."""
    if len(row) == 0:
        return np.empty(0)
    first = int(row.min())
    values = rows(top + first, top + int(row.max()) + 1)
    return values[row - first, column].astype(np.float64)


def _longest_burn_out(surface: Array | float) -> Array:
    """Longest burn-out time of any kind of fuel at a surface fuel load (kg/m2), s."""
    return np.max(
        [emissions.burn_out(surface, np.int8(kind)) for kind in range(len(emissions.KINDS))], axis=0
    )


def _model_cell(run: Run, row: Index, column: Index) -> Index:
    """Flat index of the model cell around each fuel cell."""
    rows, columns = (
        burning.nearest(coarse, fine)[index]
        for coarse, fine, index in (
            (run.latitude, run.fuel_latitude, row),
            (run.longitude, run.fuel_longitude, column),
        )
    )
    return rows * len(run.longitude) + columns


def _merge(run: Run, fuel: Fuel, row: Index, column: Index, detail: float) -> Fuel:
    """Merge fuel into pieces of `detail` (m) or larger. A piece has one kind and lies in one model cell."""
    most = max(round(float(np.sqrt(burning.model_cell_area(run))) / detail), 1)
    parts = (
        _subdivision(run.latitude, run.fuel_latitude, most)[row],
        _subdivision(run.longitude, run.fuel_longitude, most)[column],
    )
    _, first, group = np.unique(
        ((fuel.cell * most + parts[0]) * most + parts[1]) * len(emissions.KINDS) + fuel.kind,
        return_index=True,
        return_inverse=True,
    )
    if len(first) == len(row):
        return fuel
    weight = fuel.surface + fuel.canopy
    surface = np.bincount(group, fuel.surface).astype(np.float64, copy=False)

    def mean(values: Array, weight: Array = weight) -> Array:
        whole = np.bincount(group, weight)
        return np.bincount(group, weight * values) / np.where(whole > 0.0, whole, 1.0)

    begin, leave, over = np.full(len(first), np.inf), *np.full((2, len(first)), -np.inf)
    np.minimum.at(begin, group, fuel.begin)
    np.maximum.at(leave, group, fuel.begin + fuel.crossing)
    np.maximum.at(over, group, fuel.over)
    return Fuel(
        fuel.fuel_cell[first],
        fuel.cell[first],
        mean(fuel.arrival),
        begin,
        leave - begin,
        over,
        surface,
        np.bincount(group, fuel.canopy).astype(np.float64, copy=False),
        fuel.kind[first],
        np.where(surface > 0.0, mean(fuel.slow, fuel.surface), fuel.slow[first]),
        np.stack([mean(fuel.position[:, axis]) for axis in range(3)], axis=-1),
    )


def _subdivision(coarse: Array, fine: Array, most: int) -> Index:
    """Subdivision index of fuel cells within their model cell along one axis, at most `most` parts."""
    inside = burning.nearest(coarse, fine)
    count = np.bincount(inside, minlength=len(coarse))
    first = np.full(len(coarse), len(fine))
    np.minimum.at(first, inside, np.arange(len(fine)))
    return (np.arange(len(fine)) - first[inside]) * most // np.maximum(count[inside], most)
