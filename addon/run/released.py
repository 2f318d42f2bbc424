"""Energy budget: heat that a run releases, compared with the heat of the fuel that burns."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from firetwin_core import constants
from firetwin_core.run import Run
from numpy.typing import NDArray

from . import areas, blocks, burned_fraction, burning

_MUCH = 1.1  # times the fuel's heat; fluxes at discrete times give the total to about a tenth


def energy(run: Run) -> float:
    """Integrate the released heat of the run (J): flux times cell area, trapezoidal rule in time."""
    return float(np.sum(run.heat_released() * burning.model_cell_areas(run)))


def of_fuel(run: Run) -> float:
    """Compute the heat (J) of all surface and canopy fuel that burned by the run's end, at 17.433 MJ/kg.

    If the run has burned fractions, a partly burned cell counts in part.
    """
    strip, width = areas.area_factors(run.fuel_latitude, run.fuel_longitude)
    last, total = float(run.times[-1]), 0.0
    burned = _burned(run, last)
    for first, end in blocks.rows(run):
        load = sum(
            np.nan_to_num(run.fuel_rows(f"{layer}_fuel", first, end)) for layer in ("surface", "canopy")
        )
        total += float(strip[first:end] @ ((load * burned(first, end)) @ width))
    return constants.HEAT_OF_COMBUSTION * total


def _burned(run: Run, time: float) -> Callable[[int, int], NDArray]:
    """Return a reader of the burned fraction (0..1) of rows of cells by a time (s)."""
    if run.has(burned_fraction.FIELD):
        share = burned_fraction.at(run, time)
        return lambda first, end: share[first:end]
    arrival = blocks.arrival(run)
    return lambda first, end: arrival(first, end) <= time


def warnings(released: float, fuel: float) -> list[str]:
    """Warn if a run releases more heat than its fuel holds (J each)."""
    if released <= _MUCH * fuel or fuel <= 0.0:
        return []
    return [
        f"the run releases {released / fuel:,.1f} times the heat of the fuel that burns in it: its heat_flux "
        "is too large, or its fuel too little"
    ]
