"""Burned area of a run that has heat fluxes alone, with partly burned cells counted by their heat.

Fuel burns as exp(-age / delay) (Mandel et al. 2011, doi 10.5194/gmd-4-591-2011, eq. 3). A cell with the flux
F (W/m2) that has released the heat Q (J/m2) therefore still has F x delay to release, and its burned fraction
is (Q + F x delay) / heat of all of its fuel. Cells inside the fire have burned completely, so a line through
their Q and F gives the delay and the heat.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from . import burning

_FIRE = 1.0  # W/m2, least flux of a burning cell (cpp/run/scan.hpp)
_CELLS = 8  # least number of completely burned cells for the line
_SCATTER = 0.1  # largest relative standard deviation of their heat; noisier fluxes do not tell
_KEPT = 1 << 28  # bytes of fluxes in memory; larger fields are read twice
_REACH = 2  # cells around a cell whose heat it has, if it has not burned completely

Array = NDArray[np.float64]


@lru_cache(maxsize=2)
def areas(run: Run) -> Array | None:
    """Compute the burned area (m2) at each model time; None if too few cells have burned completely."""
    times = np.asarray(run.times)
    if len(times) < 3:
        return None
    load = _load(run)
    heat, burns = np.zeros(load.shape), np.zeros(load.shape, bool)
    last, first = heat, np.asarray(run.heat_flux(0)) >= _FIRE
    fluxes = _fluxes(run)
    for released, flux, *_ in _course(run, times, fluxes):
        heat, last, burns = released, flux, burns | (flux >= _FIRE)
    if not (load[burns] > 0.0).all():
        load = np.ones_like(load)
    inside = burns & _all_around(burns)
    line = _line(*(values[inside & ~first] / load[inside & ~first] for values in (heat, last)))
    if line is None:
        return None
    delay, typical = line
    own = np.where(inside, heat + delay * last, 0.0)
    near = _near(own, np.where(inside, load, 0.0))
    total = np.where(inside, own, np.where(near > 0.0, near, typical) * load)
    weight = np.where(burns, burning.model_cell_areas(run), 0.0) / np.where(burns, total, 1.0)
    burned = []
    for released, flux, latest, mean in _course(run, times, fluxes):
        growing = mean / np.log1p(mean / delay) if mean > 0.0 else delay
        left = np.maximum(delay * flux, growing * latest)
        burned.append(float(np.sum(weight * np.minimum(released + left, total))))
    return np.maximum.accumulate(burned)


def _fluxes(run: Run) -> list[NDArray[np.float32]] | None:
    """Read the fluxes of all model times once; None if they are too large for the memory."""
    size = 4 * len(run.times) * run.elevation.size
    return list(run.frames("heat_flux")) if size <= _KEPT else None


def _course(
    run: Run, times: Array, fluxes: list[NDArray[np.float32]] | None
) -> Iterator[tuple[Array, Array, Array, float]]:
    """Yield the heat so far (J/m2) and the flux (W/m2) of each model time.

    Also yields the flux extrapolated to the end of its averaging period, and that period, s.
    """
    heat, before = np.zeros(run.elevation.shape), None
    for index, flux in enumerate(run.frames("heat_flux") if fluxes is None else fluxes):
        now = np.maximum(np.nan_to_num(flux.astype(np.float64), posinf=0.0, neginf=0.0), 0.0)
        step = float(times[index] - times[index - 1]) if index else float(times[1] - times[0])
        mean = step if run.mean_s is None else min(run.mean_s, step)
        if before is not None:
            heat = heat + 0.5 * step * (before + now)
        change = now - before if before is not None else np.zeros_like(now)
        yield heat + (0.5 * mean * now if index else 0.0), now, now + 0.5 * mean / step * change, mean
        before = now


def _load(run: Run) -> Array:
    """Average surface and canopy fuel (ny, nx) over the cells of the model grid, kg/m2."""
    fuel = np.nan_to_num(run.surface_fuel).astype(np.float64) + np.nan_to_num(run.canopy_fuel)
    row = burning.nearest(run.latitude, run.fuel_latitude)
    column = burning.nearest(run.longitude, run.fuel_longitude)
    total, count = np.zeros(run.elevation.shape), np.zeros(run.elevation.shape)
    place = row[:, None], column[None, :]
    np.add.at(total, place, fuel)
    np.add.at(count, place, 1.0)
    return total / np.maximum(count, 1.0)


def _line(heat: Array, flux: Array) -> tuple[float, float] | None:
    """Fit heat = total - delay x flux: delay, s, and total, J/m2; None without a clear result."""
    if len(heat) < _CELLS:
        return None
    spread = flux - flux.mean()
    delay = -float(np.sum(spread * (heat - heat.mean())) / max(float(np.sum(spread**2)), 1e-9))
    total = heat + delay * flux
    if delay <= 0.0 or not total.mean() > 0.0 or total.std() > _SCATTER * total.mean():
        return None
    return delay, float(total.mean())


def _all_around(burns: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the cells whose 8 neighbours burn; cells outside of the grid count as burning."""
    padded = np.pad(burns, 1, constant_values=True)
    rows, columns = burns.shape
    return np.logical_and.reduce([padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)])


def _near(heat: Array, load: Array) -> Array:
    """Divide the sums of heat and load of the cells around each cell; 0 if they have none."""
    rows, columns = heat.shape
    sums = []
    for values in (heat, load):
        padded, total = np.pad(values, _REACH), np.zeros_like(values)
        for i in range(2 * _REACH + 1):
            for j in range(2 * _REACH + 1):
                total += padded[i : i + rows, j : j + columns]
        sums.append(total)
    return np.divide(sums[0], sums[1], out=np.zeros_like(heat), where=sums[1] > 0.0)
