"""How fine air is solved and smoke is drawn: cells, and lengths and times that go with them.

All that was chosen for a fire of 15 km, on cells of `REFERENCE` m, grows and shrinks with the cells. Lengths
do so evenly; times as those of eddies, whose speed goes with the cube root of their size (A. N. Kolmogorov
1941, "The local structure of turbulence", Dokl. Akad. Nauk SSSR 30).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .fire import burning
from .settings.settings import Smoke

REFERENCE = 200.0  # m
FINER = 3  # cells of the nest along one of the box's
_BUDGET = Smoke.cell_budget
_CELLS = np.array(
    [5, 6.5, 8, 10, 13, 16, 20, 25, 32, 40, 50, 65, 80, 100, 130, 160, 200, 250, 320, 400, 640, 1000, 1600.0]
)
_ACROSS = 75.0  # cells along what burns: a column of a few cells has no turrets
_FUEL = 3.0  # cells of the flow in one of the fuel, at most: heat is known no finer
_ROUND = 125.0, 50.0  # cells of air before and behind, and beside
_SLIM = 0.7  # width of what burns over its length (assumed, for the cost alone)
LEVELS = 48, 56  # of the box and of the nest
NEST = 180  # cells along a side of the nest
_COVERED = 45.0  # of its 60 cells of the box, along what burns: all cameras of a small fire share a nest
_MOST = 8.0e6  # cells of the box: 1 GB
_STEP = 10.0  # s
_BEFORE = 1800.0  # s before the first frame that count as part of it
_SHARE = 0.01  # of what burns that may lie outside, on each side
_NOTHING = 15_000.0  # m, of a run in which nothing burns


@dataclass(frozen=True)
class Scale:
    """Scale of a flow.

    Attributes
    ----------
    cell
        Of the outer box, m.
    nested
        Whether there is time for cells a third as wide where cameras look.
    """

    cell: float = REFERENCE
    nested: bool = True

    @property
    def ratio(self) -> float:
        """Cells over those that everything was chosen for."""
        return self.cell / REFERENCE

    def length(self, metres: float) -> float:
        """What is so long (m) at cells of `REFERENCE`."""
        return metres * self.ratio

    def time(self, seconds: float) -> float:
        """What takes so long (s) at cells of `REFERENCE`."""
        return seconds * self.ratio ** (2.0 / 3.0)

    @property
    def step(self) -> float:
        """Of the box's time, s."""
        return self.time(_STEP)


def choose(extent: float, fuel_cell: float, budget: float = _BUDGET) -> Scale:
    """The finest scale whose cells a budget pays for.

    Parameters
    ----------
    extent, fuel_cell
        Length of what burns, and of a fuel cell, m.
    budget
        Cells solved for each second of the fire, millions.
    """
    finest = np.clip(extent / _ACROSS, _CELLS[0], REFERENCE) * (_BUDGET / budget) ** 0.25
    finest = max(float(finest), fuel_cell / _FUEL)
    found = [
        Scale(float(cell), nested)
        for cell in _CELLS[0.999 * finest <= _CELLS]
        for nested in (True, False)
        if not (nested and cell < min(extent / _COVERED, REFERENCE))
        and _affordable(Scale(float(cell), nested), extent, budget)
    ]
    return min(
        found, key=lambda each: each.cell / FINER**each.nested, default=Scale(float(_CELLS[-1]), False)
    )


def extent(run: Run, arrival: NDArray, first: float, last: float) -> float:
    """Length (m) of what burns between two model times (s): the longer side of a box round all but a little.

    Parameters
    ----------
    arrival
        (fy, fx) s, NaN where never.
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
