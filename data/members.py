"""Synthetic ensemble of the sample's fire: `firetwin sample OUT --members N`.

Each member is the sample's fire with other rates of spread. Its arrival times are minimum travel times
(Finney, Forest Science 48(3), 2002) over the sample's rate, 1 / |grad arrival|, times invented factors: one
of fuel moisture, one that turns the wind, and a smooth field of local differences. Weather stays at the place
where the sample's fire met it, also for a quicker member.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import stored
from .grid import FUEL_CELL_SIZE, FUEL_CELLS

SEED = 2014
COARSE = 4  # fuel cells per cell of travel times
CELLS = FUEL_CELLS // COARSE
CELL_SIZE = FUEL_CELL_SIZE * COARSE  # m

# Standard deviations, invented: of the logarithm of the rate, and of the wind's direction.
MOISTURE, LOCAL, TURN = 0.10, 0.25, np.radians(12.0)
WIND = 0.5  # weight of the wind's direction in the logarithm of the rate
LENGTH = 3000.0  # m, of local differences
SLOWEST, FASTEST = 2e-3, 3.0  # m/s
PATHS = 1.08  # fitted: gradients of averaged times miss quick detours
MISSED = 0.25  # rate in cells that the sample's fire missed / nearest rate, fitted to its burned area

_STEPS = [(dy, dx) for dy in (-2, -1, 0, 1, 2) for dx in (-2, -1, 0, 1, 2) if np.gcd(dy, dx) == 1]


@dataclass(frozen=True, eq=False)
class Spread:
    """Rate of spread of the sample's fire on the coarse grid.

    Attributes
    ----------
    arrival
        (CELLS, CELLS) s after the start, NaN never: about half of the cell has burned by then, so that burned
        areas are the sample's, to 1 %.
    rate
        (CELLS, CELLS) m/s; 0 without fuel.
    heading
        (CELLS, CELLS) direction of spread, radians from east.
    """

    arrival: NDArray[np.float64]
    rate: NDArray[np.float64]
    heading: NDArray[np.float64]

    @classmethod
    def of(cls, sample: stored.Sample) -> Spread:
        """Derive rates from the arrival times; cells that the sample's fire missed take the nearest ones."""
        blocks = sample.arrival.reshape(CELLS, COARSE, CELLS, COARSE)
        touched = np.isfinite(blocks).any((1, 3))
        total = np.nansum(blocks, (1, 3)) / np.maximum(np.isfinite(blocks).sum((1, 3)), 1)
        mean = np.where(touched, total, np.nan)
        north, east = np.gradient(_smooth(mean), CELL_SIZE)
        slowness = np.hypot(north, east)
        slowness[~touched | (slowness == 0.0)] = np.nan
        parts = [_filled(each) for each in (np.log(slowness), east / slowness, north / slowness)]
        arrival = _half_burned(blocks)
        fuel = (sample.surface + sample.canopy > 0.0).reshape(blocks.shape).mean((1, 3)) >= 0.5
        missed = np.where(np.isfinite(arrival), 1.0, MISSED)
        rate = np.clip(PATHS * np.exp(-parts[0]), SLOWEST, FASTEST) * fuel * missed
        return cls(arrival, rate, np.arctan2(parts[2], parts[1]))


def _half_burned(blocks: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return the time (ny, nx) at which half of the cells of blocks (ny, k, nx, k) have burned, NaN never.

    It is the time of the first cell beyond half, and of the second one in every other block: the first alone
    would make burned areas 1.5 % too large.
    """
    ny, k, nx, _ = blocks.shape
    ordered = np.sort(blocks.transpose(0, 2, 1, 3).reshape(ny, nx, -1), axis=-1)  # NaN last
    row, column = np.mgrid[:ny, :nx]
    return ordered[row, column, k * k // 2 + (row + column) % 2].astype(np.float64)


def arrival(spread: Spread, number: int) -> NDArray[np.float32]:
    """Compute the arrival times (CELLS, CELLS) of a member, s after the start, +inf never.

    Member 0 is the sample's fire itself. Others depend on their number alone.
    """
    if not number:
        return np.where(np.isfinite(spread.arrival), spread.arrival, np.inf).astype(np.float32)
    rng = np.random.default_rng([SEED, number])
    moisture, turn = rng.normal(0.0, MOISTURE), rng.normal(0.0, TURN)
    heading = spread.heading[spread.arrival > 0.0]
    wind = np.arctan2(np.sin(heading).mean(), np.cos(heading).mean())
    turned = np.cos(spread.heading - wind - turn) - np.cos(spread.heading - wind)
    rate = spread.rate * np.exp(moisture + LOCAL * _field(rng) + WIND * turned)
    burned = spread.arrival <= 0.0
    times = np.where(burned, spread.arrival, travel(rate, np.where(burned, 0.0, np.inf)))
    return np.where(times <= stored.MINUTES * 60.0, times, np.inf).astype(np.float32)


def travel(rate: NDArray[np.float64], start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute minimum travel times (s) from cells that burn at known times (inf elsewhere).

    Fire travels to 16 neighbours at the mean slowness of both cells. At a uniform rate times are exact along
    these directions, and up to 2.8 % late between them.
    """
    rows, columns = rate.shape
    with np.errstate(divide="ignore"):
        slow = (0.5 * CELL_SIZE / rate).tolist()
    steps = [(dy, dx, float(np.hypot(dy, dx))) for dy, dx in _STEPS]
    times = start.tolist()
    heap = [(times[y][x], y, x) for y, x in np.argwhere(np.isfinite(start)).tolist()]
    heapq.heapify(heap)
    while heap:
        time, y, x = heapq.heappop(heap)
        if time > times[y][x]:
            continue
        here = slow[y][x]
        for dy, dx, length in steps:
            to_y, to_x = y + dy, x + dx
            if 0 <= to_y < rows and 0 <= to_x < columns:
                then = time + length * (here + slow[to_y][to_x])
                if then < times[to_y][to_x]:
                    times[to_y][to_x] = then
                    heapq.heappush(heap, (then, to_y, to_x))
    return np.array(times)


def fine(times: NDArray[np.float32]) -> NDArray[np.float64]:
    """Interpolate a member's arrival times to the fuel grid, s; NaN never."""
    at = (np.arange(FUEL_CELLS) + 0.5) / COARSE - 0.5
    low = np.clip(np.floor(at).astype(int), 0, CELLS - 2)
    part = np.clip(at - low, 0.0, 1.0)
    known = np.isfinite(times)
    values = _filled(np.where(known, times, np.nan))
    across = values[:, low] * (1 - part) + values[:, low + 1] * part
    whole = across[low] * (1 - part)[:, None] + across[low + 1] * part[:, None]
    return np.where(known.repeat(COARSE, 0).repeat(COARSE, 1), whole, np.nan)


def sample_of(number: int) -> stored.Sample:
    """Return the sample with a member's arrival times."""
    sample = stored.load()
    return sample._replace(arrival=fine(arrival(Spread.of(sample), number))) if number else sample


def _field(rng: np.random.Generator) -> NDArray[np.float64]:
    """Draw a smooth field of unit variance with a Gaussian spectrum of the length `LENGTH`."""
    noise = np.fft.rfft2(rng.standard_normal((CELLS, CELLS)))
    wave = np.hypot(np.fft.fftfreq(CELLS)[:, None], np.fft.rfftfreq(CELLS)[None]) * 2 * np.pi / CELL_SIZE
    made = np.fft.irfft2(noise * np.exp(-0.25 * (wave * LENGTH) ** 2), (CELLS, CELLS))
    return made / made.std()


def _smooth(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Average known values over 3 x 3 cells."""
    known = np.isfinite(values)
    total, count = _sum(np.where(known, values, 0.0)), _sum(known.astype(float))
    return np.where(known, total / np.maximum(count, 1.0), _filled(values))


def _filled(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Fill NaN from the nearest known cells, ring by ring."""
    values = np.array(values, np.float64)
    while (missing := np.isnan(values)).any():
        total, count = _sum(np.where(missing, 0.0, values)), _sum((~missing).astype(float))
        if not count.any():
            break
        values = np.where(missing & (count > 0.0), total / np.maximum(count, 1.0), values)
    return values


def _sum(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum over 3 x 3 cells."""
    padded = np.pad(values, 1)
    rows, columns = values.shape
    return sum(padded[y : y + rows, x : x + columns] for y in range(3) for x in range(3))
