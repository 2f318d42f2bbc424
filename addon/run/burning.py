"""Burning cells: cell size, crossing time of the front, and wind around the fire. Needs no Blender."""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from . import areas
from .frame import local_frame

BURN_TIME = 600.0  # s, burn-out time of a cell's fuel
CROSSING = (60.0, 3600.0)  # s
# m, cell size from which `CROSSING` is the least crossing time; s, the least on the finest cells
_COARSE, _QUICK = 60.0, 2.0
_WIND_STEP = 600.0  # s between wind samples
CROWN_FIRE_FLUX = 3.0e5
"""W/m2, heat flux of an intense flame front: crown fires reach 200 to 300 kW/m2 (Butler et al. 2004, doi
10.1139/x04-060).
"""

Array = NDArray[np.float64]


def cell_area(run: Run) -> float:
    """Compute the area of a fuel cell, m2."""
    return _area(run, run.fuel_latitude, run.fuel_longitude, (run.latitude, run.longitude))


def fuel_cell(run: Run) -> tuple[float, float]:
    """Return the width and height of a fuel cell, m."""
    within = run.latitude, run.longitude
    return areas.cell_size(run.fuel_latitude, run.fuel_longitude, local_frame(run).latitude, within)


def model_cell_area(run: Run) -> float:
    """Compute the area of a cell of the model grid, m2."""
    if run.elevation.size == 1:
        return cell_area(run) * run.surface_fuel.size
    return _area(run, run.latitude, run.longitude)


def model_cell_areas(run: Run) -> Array:
    """Compute the area (ny, nx) of each cell of the model grid, m2; an axis of one value has a mean width."""
    if min(run.elevation.shape) == 1:
        return np.full(run.elevation.shape, model_cell_area(run))
    return areas.cell_areas(run.latitude, run.longitude)


def _area(run: Run, rows: Array, columns: Array, within: tuple[Array, Array] | None = None) -> float:
    """Compute the mean cell area of a grid, m2, from its spacing at the run's centre."""
    width, height = areas.cell_size(rows, columns, local_frame(run).latitude, within)
    return width * height


def least_crossing(cell: float) -> float:
    """Compute the lower bound of the crossing time of a cell (m), s; coarse cells resolve no faster front.

    On cells of 20 m a front of 3 m/s is not slowed.
    """
    return float(np.clip(CROSSING[0] * (cell / _COARSE) ** 2, _QUICK, CROSSING[0]))


def crossing(
    arrival: NDArray, row: NDArray[np.int64], column: NDArray[np.int64], least: float = CROSSING[0]
) -> Array:
    """Compute the crossing time (n,) of fuel cells, s: cell size times the gradient of arrival time.

    Along each axis the smaller one-sided difference counts: a jump to the arrival of another fire is not a
    slow front. In this time a cell begins to release its heat, for any direction of spread. From the first
    corner of a cell to the last (cpp/flux/crossing_time.hpp) the front needs up to 1.4 times as long.

    Parameters
    ----------
    arrival
        Arrival time (fy, fx), s; NaN where it never burns.
    least
        Lower bound, s.
    """
    here, steps = arrival[row, column].astype(np.float64), []
    for axis, index in enumerate((row, column)):
        gaps = []
        for step in (-1, 1):
            beside = np.clip(index + step, 0, arrival.shape[axis] - 1)
            there = arrival[beside, column] if axis == 0 else arrival[row, beside]
            gaps.append(np.where(beside == index, np.nan, np.abs(here - there)))
        steps.append(np.nan_to_num(np.fmin(*gaps)))
    return np.clip(np.hypot(*steps), least, CROSSING[1])


def nearest(axis: ArrayLike, values: ArrayLike) -> NDArray[np.int64]:
    """Index of the axis value nearest to each value; the axis may ascend or descend."""
    axis = np.asarray(axis, np.float64)
    order = np.argsort(axis, kind="stable")
    edges = 0.5 * (axis[order][1:] + axis[order][:-1])
    return order[np.searchsorted(edges, values)]


def wind_at(run: Run, times: Array, within: tuple[slice, slice]) -> Array:
    """Average the wind (n, 2), m/s, over a window of the model grid at model times (n,); 0 without data."""
    times = np.asarray(times, np.float64)
    if not {"wind_east", "wind_north"} <= set(run.fields) or len(times) == 0:
        return np.zeros((len(times), 2))
    run_times = np.asarray(run.times)
    low, high = np.clip([times.min(), times.max()], run_times[0], run_times[-1])
    wanted = np.arange(low, high + _WIND_STEP, _WIND_STEP)
    indices = np.unique(np.clip(np.searchsorted(run_times, wanted), 0, len(run_times) - 1))
    rows, columns = within
    winds = np.array(
        [[float(np.nanmean(part[rows, columns])) for part in run.wind(int(index))] for index in indices]
    )
    return np.stack([np.interp(times, run_times[indices], winds[:, axis]) for axis in (0, 1)], axis=-1)


def surroundings(run: Run, arrival: Array) -> tuple[slice, slice]:
    """Find rows and columns of the model grid around all burned cells of `arrival` (fy, fx; NaN unburned)."""
    burned = np.isfinite(arrival)
    slices = []
    for axis, (fine, coarse) in enumerate(
        ((run.fuel_latitude, run.latitude), (run.fuel_longitude, run.longitude))
    ):
        hit = np.asarray(fine)[burned.any(axis=1 - axis)]
        inside = np.flatnonzero((coarse >= hit.min()) & (coarse <= hit.max())) if len(hit) else np.empty(0)
        whole = len(inside) == 0
        slices.append(slice(None) if whole else slice(int(inside[0]), int(inside[-1]) + 1))
    return slices[0], slices[1]
