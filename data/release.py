"""Heat release of burning fuel over time.

The front crosses a cell of size d in d / R, R being its speed; each point of the cell starts to burn as the
front passes and its heat release decays exponentially (the form used by WRF-SFIRE for the weight of ground
fuel, Mandel et al. 2011, doi 10.5194/gmd-4-591-2011). The share released since the front arrived has a
closed form, so heat summed over output times is exact for any interval.
"""

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from .grid import FUEL_CELL_SIZE, FUEL_CELLS, MODEL_CELLS, REFINEMENT
from .stored import Sample

CANOPY_SHARE = np.array([0.0, 0.5, 0.95])  # of canopy fuel consumed by surface, passive and active crown fire
BURN_OUT_SURFACE = (120.0, 300.0)  # s: grass, and addition per kg/m2 (timber litter and wood burn longer)
BURN_OUT_CANOPY = 90.0  # s
CROSSING = (60.0, 3600.0)  # s, limits on the time that the front takes to cross a cell
OVER = 14.0  # burn-out times after which the remainder, e^-14, is neglected


@dataclass(frozen=True)
class Burns:
    """Burning cells as flat arrays (n,).

    `cell` is on the model grid, `heat` in J; the front's `arrival` and `crossing` and the `burn_out` in s. A
    cell with crown fire appears twice, once for each kind of fuel.
    """

    cell: NDArray[np.int64]
    heat: NDArray[np.float64]
    arrival: NDArray[np.float64]
    crossing: NDArray[np.float64]
    burn_out: NDArray[np.float64]

    def released(self, time: float, which: NDArray | slice = slice(None)) -> NDArray[np.float64]:
        """Return the share of each burn's heat released by `time` (s after the start), 0 to 1."""
        since = np.maximum(time - self.arrival[which], 0)
        crossing, burn_out = self.crossing[which], self.burn_out[which]
        lit = np.minimum(since, crossing)
        # Mean over the spots lit at times 0..crossing after the arrival of 1 - exp(-(since - lit at) /
        # burn_out).
        tail = np.exp(-(since - lit) / burn_out) - np.exp(-since / burn_out)
        return (lit - burn_out * tail) / crossing


def burns(sample: Sample) -> Burns:
    """Find all burning cells of the sample, in order of arrival."""
    burned = np.isfinite(sample.arrival) & (sample.surface + sample.canopy > 0)
    row, column = np.nonzero(burned)
    cell = row // REFINEMENT * MODEL_CELLS + column // REFINEMENT
    crossing = np.clip(crossing_time(sample.arrival), *CROSSING)[burned]
    arrival = sample.arrival[burned]
    surface, canopy = sample.surface[burned].astype(float), sample.canopy[burned].astype(float)
    consumed = canopy * CANOPY_SHARE[sample.crown[burned]]
    joules = constants.HEAT_OF_COMBUSTION * FUEL_CELL_SIZE**2
    crowns = consumed > 0
    parts = Burns(
        np.concatenate([cell, cell[crowns]]),
        np.concatenate([surface, consumed[crowns]]) * joules,
        np.concatenate([arrival, arrival[crowns]]),
        np.concatenate([crossing, crossing[crowns]]),
        np.concatenate(
            [BURN_OUT_SURFACE[0] + BURN_OUT_SURFACE[1] * surface, np.full(crowns.sum(), BURN_OUT_CANOPY)]
        ),
    )
    order = np.argsort(parts.arrival, kind="stable")
    return Burns(
        *(field[order] for field in (parts.cell, parts.heat, parts.arrival, parts.crossing, parts.burn_out))
    )


def crossing_time(arrival: NDArray) -> NDArray[np.float64]:
    """Return the crossing time of the front in each cell, s: cell size times the gradient of arrival time."""
    steps = []
    for axis in (0, 1):
        ahead = np.diff(arrival, axis=axis)
        padding = [(0, 0), (0, 0)]
        padding[axis] = (0, 1)
        after = np.pad(ahead, padding, constant_values=np.nan)
        padding[axis] = (1, 0)
        before = np.pad(ahead, padding, constant_values=np.nan)
        # The smaller one-sided difference: a jump to the arrival of another fire is not a slow front.
        steps.append(np.nan_to_num(np.fmin(np.abs(after), np.abs(before))))
    return np.hypot(*steps)


class Released:
    """Heat released between successive times, on the model grid; times must ascend."""

    def __init__(self, parts: Burns) -> None:
        self.parts = parts
        self.end = parts.arrival + parts.crossing + OVER * parts.burn_out
        self.active = np.zeros(0, dtype=np.int64)
        self.before = np.zeros(0)
        self.next = 0
        self.time = -np.inf

    def until(self, time: float) -> NDArray[np.float64]:
        """Return joules (ny, nx) released since the last call; the first call only sets the time."""
        parts = self.parts
        first = np.isneginf(self.time)
        came = np.searchsorted(parts.arrival, time, side="right")
        self.active = np.concatenate([self.active, np.arange(self.next, came)])
        self.before = np.concatenate([self.before, np.zeros(came - self.next)])
        share = parts.released(time, self.active)
        over = self.end[self.active] < time
        share[over] = 1.0
        heat = parts.heat[self.active] * (share - self.before)
        result = np.bincount(parts.cell[self.active], heat, minlength=MODEL_CELLS**2)
        self.active, self.before = self.active[~over], share[~over]
        self.next, self.time = came, time
        return np.zeros((MODEL_CELLS, MODEL_CELLS)) if first else result.reshape(MODEL_CELLS, MODEL_CELLS)


def consumed_fuel(sample: Sample) -> NDArray[np.float64]:
    """Return the fuel (fy, fx) that burns in each cell in total, kg/m2; 0 in unburned cells."""
    share = CANOPY_SHARE[sample.crown] * sample.canopy
    return np.where(np.isfinite(sample.arrival), sample.surface + share, 0.0).reshape(FUEL_CELLS, FUEL_CELLS)
