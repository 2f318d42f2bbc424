"""The fuel that burns in some time, gathered from the fuel grid; without Blender."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import blocks, burned_fraction, fuel_category
from ...run.frame import local_frame
from ..terrain.elevation import Elevation
from . import burning, emissions

BURN_OUT_CANOPY = emissions.KINDS[emissions.CROWN].burn_out[0]  # s, foliage and twigs (assumed)
_OVER = 14.0  # burn-out times after which what is left, e^-14, is not worth a look
DETAIL = (
    75.0  # m, at a fire of 15 km; fuel cells nearer than this burn as one: a finer run makes no more of them
)

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class Fuel:
    """Fuel that burns, n pieces by the time that they begin to: a fuel cell, or several of one model cell.

    Attributes
    ----------
    fuel_cell, cell
        (n,) flat index on the fuel grid (of the first cell of a piece), and on the model grid.
    arrival
        (n,) s, when the front is in its middle.
    begin, crossing, over
        (n,) s, when the front enters it, how long it takes to leave it, and when the piece has burned out.
    surface, canopy
        (n,) kg for each m2 of a fuel cell's area, summed over the cells of the piece; of the burned
        fraction of its cells, where the run has it.
    kind
        (n,) kind of the surface fuel, of `emissions.KINDS`; all of a piece is of one.
    slow
        (n,) s, burn-out time of the surface fuel.
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
        """Some of it."""
        return Fuel(*(getattr(self, field.name)[chosen] for field in fields(self)))


def gather(
    run: Run,
    known: Array | None,
    first: float,
    last: float,
    before: float,
    relief: Elevation | None = None,
    detail: float = DETAIL,
) -> Fuel:
    """Fuel that burns between the model times `first` and `last`, or that `before` s earlier caught fire.

    Of the run's fields only the rows are read in which something burns, some at a time.

    Parameters
    ----------
    known
        (fy, fx) s, arrival times, NaN where never; none asks the run for its own.
    relief
        Heights of the ground; None: the run's.
    detail
        Fuel cells nearer than this burn as one, m.
    """
    heights = relief or Elevation(run)
    arrival, share = blocks.arrival(run, known), None
    if run.has(burned_fraction.FIELD):
        share = burned_fraction.at(run, float(run.times[-1]))
    window = first, last, before
    parts = [_of_rows(run, heights, arrival, share, rows, window) for rows in blocks.rows(run)]
    every = Fuel(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Fuel)))
    row, column = np.divmod(every.fuel_cell, len(run.fuel_longitude))
    found = _pieces(run, every, row, column, detail)
    return found.take(np.argsort(found.begin, kind="stable"))


def _of_rows(
    run: Run,
    heights: Elevation,
    arrival: Callable[[int, int], NDArray],
    share: NDArray | None,
    rows: tuple[int, int],
    window: tuple[float, float, float],
) -> Fuel:
    """The fuel of some rows, each cell a piece."""
    (top, end), (first, last, before) = rows, window
    edge, beyond = max(top - 2, 0), min(end + 2, len(run.fuel_latitude))  # a row on each side for its slope
    time = arrival(edge, beyond)
    if share is not None:
        time = _touched(time, share[edge:beyond])
    inner = time[top - edge : end - edge]
    came = inner < last + burning.CROSSING[1]
    if came.any():  # the slowest fuel of these rows tells what may still burn
        most = np.fmax.reduce(run.fuel_rows("surface_fuel", top, end), axis=None, initial=0.0)
        longest = burning.CROSSING[1] + _OVER * max(float(_slowest(most)), BURN_OUT_CANOPY)
        came &= inner > first - max(longest, before)
    row, column = np.divmod(np.flatnonzero(came), inner.shape[1])
    surface = np.nan_to_num(_at(partial(run.fuel_rows, "surface_fuel"), top, row, column))
    burning_out = np.maximum(_slowest(surface), BURN_OUT_CANOPY)
    near = inner[row, column] > first - np.maximum(burning.CROSSING[1] + _OVER * burning_out, before)
    row, column, surface = row[near], column[near], surface[near]
    canopy = np.nan_to_num(_at(partial(run.fuel_rows, "canopy_fuel"), top, row, column))
    category = None
    if run.has(fuel_category.FIELD):
        category = _at(partial(run.fuel_rows, fuel_category.FIELD), top, row, column)
    kind = emissions.kind(surface, canopy, category)
    slow = emissions.burn_out(surface, kind)
    came = inner[row, column].astype(np.float64)
    least = burning.least_crossing(float(np.sqrt(burning.cell_area(run))))
    crossing = burning.crossing(time, row + top - edge, column, least)
    begin = came - 0.5 * crossing  # the arrival time is that of the cell's centre
    over = begin + crossing + _OVER * np.maximum(slow, BURN_OUT_CANOPY)
    recent = (over > first) | (came >= first - before)
    burns = np.flatnonzero((surface + canopy > 0.0) & (begin < last) & recent)
    row, column = row[burns], column[burns]
    part = 1.0 if share is None else share[row + top, column].astype(np.float64)
    height = np.nan_to_num(_at(heights.rows, top, row, column))
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


def _touched(time: NDArray, share: NDArray) -> NDArray:
    """Arrival times, also of cells that burn in part though the front never gets to their middle.

    Theirs is the latest of their neighbours', which the front came from; without one they have none.
    """
    padded, found = np.pad(time, 1, constant_values=np.nan), np.full_like(time, np.nan)
    rows, columns = time.shape
    for y in range(3):
        for x in range(3):
            found = np.fmax(found, padded[y : y + rows, x : x + columns])
    return np.where(np.isnan(time) & (share > 0.0), found, time)


def _at(rows: Callable[[int, int], NDArray], top: int, row: Index, column: Index) -> Array:
    """Values of what `rows` reads of the fuel grid at rows, counted from `top` on, and columns."""
    if len(row) == 0:
        return np.empty(0)
    first = int(row.min())
    values = rows(top + first, top + int(row.max()) + 1)
    return values[row - first, column].astype(np.float64)


def _slowest(surface: Array | float) -> Array:
    """Burn-out time (s) of so much surface fuel (kg/m2) at most, of whatever kind."""
    return np.max(
        [emissions.burn_out(surface, np.int8(kind)) for kind in range(len(emissions.KINDS))], axis=0
    )


def _model_cell(run: Run, row: Index, column: Index) -> Index:
    """The cell of the model grid that fuel cells lie in."""
    rows, columns = (
        burning.nearest(coarse, fine)[index]
        for coarse, fine, index in (
            (run.latitude, run.fuel_latitude, row),
            (run.longitude, run.fuel_longitude, column),
        )
    )
    return rows * len(run.longitude) + columns


def _pieces(run: Run, fuel: Fuel, row: Index, column: Index, detail: float) -> Fuel:
    """The same in pieces of `detail` (m) or larger, none of two kinds or in two cells of the model grid."""
    most = max(round(float(np.sqrt(burning.model_cell_area(run))) / detail), 1)
    parts = (
        _part(run.latitude, run.fuel_latitude, most)[row],
        _part(run.longitude, run.fuel_longitude, most)[column],
    )
    _, first, group = np.unique(
        ((fuel.cell * most + parts[0]) * most + parts[1]) * len(emissions.KINDS) + fuel.kind,
        return_index=True,
        return_inverse=True,
    )
    if len(first) == len(row):
        return fuel
    weight = fuel.surface + fuel.canopy
    surface = np.bincount(group, fuel.surface)

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
        np.bincount(group, fuel.canopy),
        fuel.kind[first],
        np.where(surface > 0.0, mean(fuel.slow, fuel.surface), fuel.slow[first]),
        np.stack([mean(fuel.position[:, axis]) for axis in range(3)], axis=-1),
    )


def _part(coarse: Array, fine: Array, most: int) -> Index:
    """Which of at most `most` parts of its model cell, along one axis, each fuel cell lies in."""
    inside = burning.nearest(coarse, fine)
    count = np.bincount(inside, minlength=len(coarse))
    first = np.full(len(coarse), len(fine))
    np.minimum.at(first, inside, np.arange(len(fine)))
    return (np.arange(len(fine)) - first[inside]) * most // np.maximum(count[inside], most)
