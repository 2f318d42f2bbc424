"""Smoke scale: cell size of the flow solver and of drawn smoke, with the lengths and times that follow it.

Parameters were tuned for a fire of 15 km on cells of `REFERENCE` m and scale with the cells. Lengths scale
linearly. Times scale as in eddies, whose speed is proportional to the cube root of their size (A. N.
Kolmogorov 1941, "The local structure of turbulence", Dokl. Akad. Nauk SSSR 30).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import burning
from ..sections import SmokeSettings

REFERENCE = 200.0  # m
FINER = 3  # nest cells along a cell of the outer domain
_BUDGET = SmokeSettings.cell_budget
_CELLS = np.array(
    [5, 6.5, 8, 10, 13, 16, 20, 25, 32, 40, 50, 65, 80, 100, 130, 160, 200, 250, 320, 400, 640, 1000, 1600.0]
)
_ACROSS = 75.0  # cells along the burning area; a plume of a few cells resolves no turrets
_FUEL = 3.0  # flow cells in a fuel cell at most; heat is resolved no finer
_ROUND = 125.0, 50.0  # cells of margin along the wind, and across it
_SLIM = 0.7  # width of the burning area over its length (assumed, for the cost alone)
LEVELS = 48, 56  # levels of the outer domain and of the nest
NEST = 180  # cells along a side of the nest
# of the 60 outer cells that a nest spans, for the burning area; cameras of a small fire then share a nest
_COVERED = 45.0
_MOST = 8.0e6  # cells of the outer domain at most: 1 GB
_STEP = 10.0  # s, time step of the outer domain
_BEFORE = 1800.0  # s before the first frame that count as part of the shot
_SHARE = 0.01  # fraction of burning cells that may lie outside, on each side
_NOTHING = 15_000.0  # m, extent of a run without fire


@dataclass(frozen=True)
class Scale:
    """Scale of a flow.

    Attributes
    ----------
    cell
        Cell size of the outer domain, m.
    nested
        True if the budget allows a nest with cells a third as wide where cameras look.
    """

    cell: float = REFERENCE
    nested: bool = True

    @property
    def ratio(self) -> float:
        """Cell size relative to `REFERENCE`."""
        return self.cell / REFERENCE

    def length(self, metres: float) -> float:
        """Scale a length (m) given for cells of `REFERENCE`."""
        return metres * self.ratio

    def time(self, seconds: float) -> float:
        """Scale a time (s) given for cells of `REFERENCE`."""
        return seconds * self.ratio ** (2.0 / 3.0)

    @property
    def step(self) -> float:
        """Time step of the outer domain, s."""
        return self.time(_STEP)


def choose(extent: float, fuel_cell: float, budget: float = _BUDGET) -> Scale:
    """Finest scale within a budget of cells.

    Parameters
    ----------
    extent, fuel_cell
        Length of the burning area, and of a fuel cell, m.
    budget
        Million cell updates per second of fire time.
    """
    finest = np.clip(extent / _ACROSS, _CELLS[0], REFERENCE) * (_BUDGET / budget) ** 0.25
    finest = max(float(finest), fuel_cell / _FUEL)
    fitting = [
        Scale(float(cell), nested)
        for cell in _CELLS[0.999 * finest <= _CELLS]
        for nested in (True, False)
        if not (nested and cell < min(extent / _COVERED, REFERENCE))
        and _affordable(Scale(float(cell), nested), extent, budget)
    ]
    return min(
        fitting, key=lambda each: each.cell / FINER**each.nested, default=Scale(float(_CELLS[-1]), False)
    )


def resolves_plume(fuel_cell: float) -> bool:
    """Return whether the coarsest cells of a flow are fine enough for a fuel cell (m)."""
    return bool(fuel_cell <= _FUEL * _CELLS[-1] * 1.001)


def warnings(scale: Scale, fuel_cell: float) -> list[str]:
    """Warn if a fuel cell (m) is wider than the coarsest cells of a flow can resolve."""
    if resolves_plume(fuel_cell):
        return []
    return [
        f"fuel cells of {fuel_cell / 1000.0:,.3g} km are too coarse for a plume: smoke is solved on cells of "
        f"{scale.cell:,.0f} m, as a layer; use a finer run, or set smoke.enabled = false"
    ]


def extent(run: Run, arrival: NDArray, first: float, last: float) -> float:
    """Extent (m) of the fire between two model times (s): longer side of its bounds without outliers.

    Parameters
    ----------
    arrival
        Arrival time (fy, fx), s, NaN where never.
    """
    burns = (arrival > first - _BEFORE) & (arrival <= last)
    if not burns.any():
        burns = np.isfinite(arrival)
    if not burns.any():
        return _NOTHING
    sides = []
    for axis, size in enumerate(burning.fuel_cell(run)[::-1]):
        share = np.cumsum(burns.sum(axis=1 - axis))
        low, high = np.searchsorted(share, share[-1] * np.array([_SHARE, 1.0 - _SHARE]))
        sides.append((high - low + 1) * size)
    return float(max(sides))


def _affordable(scale: Scale, extent: float, budget: float) -> bool:
    across = extent / scale.cell
    cells = (across + _ROUND[0]) * (_SLIM * across + _ROUND[1]) * LEVELS[0]
    rate = cells / scale.step
    if scale.nested:
        rate += NEST**2 * LEVELS[1] * FINER / scale.step
    return bool(cells <= _MOST and rate <= budget * 1e6)
