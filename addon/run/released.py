"""The heat that a run releases, beside that of the fuel that burns in it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from firetwin_core import constants
from firetwin_core.run import Run
from numpy.typing import NDArray

from . import areas, blocks, burned_fraction

_MUCH = 1.1  # times the fuel's heat: fluxes at some moments give the whole to about a tenth


def energy(run: Run) -> float:
    """Heat released over the run (J): flux times cell area, integrated over time by the trapezoidal rule."""
    return float(np.sum(run.heat_released() * areas.cell_areas(run.latitude, run.longitude)))


def of_fuel(run: Run) -> float:
    """Heat (J) of all surface and canopy fuel where it burned by the run's end, at 17.433 MJ/kg.

    Of cells that burned in part that part counts, where the run has their burned fraction.
    """
    strip, width = areas.area_factors(run.fuel_latitude, run.fuel_longitude)
    last, total = float(run.times[-1]), 0.0
    burned = _burned(run, last)
    for first, end in blocks.rows(run):
        load = sum(np.nan_to_num(run.fuel_rows(f"{each}_fuel", first, end)) for each in ("surface", "canopy"))
        total += float(strip[first:end] @ ((load * burned(first, end)) @ width))
    return constants.HEAT_OF_COMBUSTION * total


def _burned(run: Run, time: float) -> Callable[[int, int], NDArray]:
    """What reads how far some rows of cells have burned by a time (s), 0 to 1."""
    if run.has(burned_fraction.FIELD):
        share = burned_fraction.at(run, time)
        return lambda first, end: share[first:end]
    arrival = blocks.arrival(run)
    return lambda first, end: arrival(first, end) <= time


def warnings(released: float, fuel: float) -> list[str]:
    """What is wrong where a run releases more than its fuel (J each)."""
    if released <= _MUCH * fuel or fuel <= 0.0:
        return []
    return [
        f"the run releases {released / fuel:,.1f} times the heat of the fuel that burns in it: its heat_flux "
        "is too large, or its fuel too little"
    ]
