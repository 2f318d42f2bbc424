"""What burns when: the cells of the fuel grid as flat arrays, for smoke and flames, without Blender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..run import areas
from ..run.frame import local_frame

BURN_TIME = 600.0  # s in which a cell's fuel burns out
HEAT = 17.433e6  # J/kg, WRF-SFIRE's cmbcnst
_WIND_STEP = 600.0  # s between the moments at which the wind is looked up

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Cells:
    """Cells of the fuel grid that burn in some time window, n of them.

    Attributes
    ----------
    arrival
        (n,) s.
    fuel
        (n,) kg/m2 burned: surface and canopy.
    position
        (n, 3) scene metres, on the ground.
    wind
        (n, 2) m/s east and north near the ground, at arrival, averaged over the fire's surroundings.
    area
        m2 of one cell.
    """

    arrival: Array
    fuel: Array
    position: Array
    wind: Array
    area: float

    def power(self, time: float) -> Array:
        """Heat released by each cell at `time`, W."""
        age = time - self.arrival
        return self.fuel * (self.area * HEAT / BURN_TIME) * ((age >= 0.0) & (age < BURN_TIME))


def cell_area(run: Run) -> float:
    """Area of a fuel cell, m2."""
    return _area(run, run.fuel_latitude, run.fuel_longitude, (run.latitude, run.longitude))


def model_cell_area(run: Run) -> float:
    """Area of a cell of the model grid, m2."""
    if run.elevation.size == 1:
        return cell_area(run) * run.surface_fuel.size
    return _area(run, run.latitude, run.longitude)


def _area(run: Run, rows: Array, columns: Array, within: tuple[Array, Array] | None = None) -> float:
    """Mean area of the cells of a grid, m2, from its spacing in the middle of the run."""
    width, height = areas.cell_size(rows, columns, local_frame(run).latitude, within)
    return width * height


def cells(run: Run, first: float, last: float) -> Cells:
    """Cells with fuel that catch fire between `first` and `last` (s)."""
    arrival = run.fuel_arrival_time().astype(np.float64)
    fuel = np.nan_to_num(run.surface_fuel.astype(np.float64)) + np.nan_to_num(
        run.canopy_fuel.astype(np.float64)
    )
    with np.errstate(invalid="ignore"):
        burn = (arrival >= first) & (arrival <= last) & (fuel > 0.0)
    elevation = np.nan_to_num(run.fuel_elevation.astype(np.float64))
    place = local_frame(run).forward_grid(run.fuel_latitude, run.fuel_longitude, elevation)
    return Cells(
        arrival[burn],
        fuel[burn],
        np.ascontiguousarray(place[burn]),
        wind_at(run, arrival[burn]),
        cell_area(run),
    )


def wind_at(run: Run, times: Array) -> Array:
    """Mean wind (n, 2) over the part of the grid that ever burns, at model times (n,) s; 0 without data."""
    times = np.asarray(times, np.float64)
    if not {"wind_east", "wind_north"} <= set(run.fields) or len(times) == 0:
        return np.zeros((len(times), 2))
    known = np.asarray(run.times)
    low, high = np.clip([times.min(), times.max()], known[0], known[-1])
    wanted = np.arange(low, high + _WIND_STEP, _WIND_STEP)
    indices = np.unique(np.clip(np.searchsorted(known, wanted), 0, len(known) - 1))
    rows, columns = _surroundings(run)
    winds = np.array(
        [[float(np.nanmean(part[rows, columns])) for part in run.wind(int(index))] for index in indices]
    )
    return np.stack([np.interp(times, known[indices], winds[:, axis]) for axis in (0, 1)], axis=-1)


def _surroundings(run: Run) -> tuple[slice, slice]:
    """Rows and columns of the model grid round everything that burns."""
    burned = np.isfinite(run.fuel_arrival_time())
    slices = []
    for axis, (fine, coarse) in enumerate(
        ((run.fuel_latitude, run.latitude), (run.fuel_longitude, run.longitude))
    ):
        hit = np.asarray(fine)[burned.any(axis=1 - axis)]
        inside = np.flatnonzero((coarse >= hit.min()) & (coarse <= hit.max())) if len(hit) else []
        whole = len(inside) == 0
        slices.append(slice(None) if whole else slice(int(inside[0]), int(inside[-1]) + 1))
    return slices[0], slices[1]
