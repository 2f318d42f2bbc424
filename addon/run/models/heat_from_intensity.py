"""Heat flux from arrival time and fuel or fireline intensity, for models that write none.

After arrival a spot's heat release rate falls linearly to zero at the burn-out time T: the fraction 1 - (1 -
s/T)^2 of its heat is released after s seconds. Each flux is the mean over its interval, the difference of
that fraction at both ends. So all intervals together release the heat of the burned fuel, to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ...errors import Error
from .. import burning

_STEPS = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600, 43200, 86400)
_FRAMES = 300
_MOST = 20_000
FRONT_HEAT = burning.CROWN_FIRE_FLUX * 120.0
"""J/m2, heat of an intense front during 120 s, the residence time of flames in timber."""
_OUTLIER = 3.0  # times the median of the neighbourhood (chosen on fires with known fuel)


@dataclass(frozen=True, eq=False)
class Release:
    """Heat flux (W/m2) from arrival time (s, NaN where never), heat (J/m2) and burn-out time (s) of cells.

    Attributes
    ----------
    times
        (nt,) s, from before the first arrival until all fuel has burned out.
    """

    shape: tuple[int, int]
    times: NDArray[np.float64]
    cell: NDArray[np.int64]
    arrival: NDArray[np.float64]
    heat: NDArray[np.float64]
    burn_out: NDArray[np.float64]

    @classmethod
    def of(cls, arrival: NDArray, heat: NDArray, burn_out: NDArray, interval: float) -> Release:
        """Release from maps; an `interval` of 0 selects one that gives 300 times at most.

        Raises
        ------
        Error
            Nothing burns, or there would be too many times.
        """
        flat = np.asarray(arrival, np.float64).ravel()
        cell = np.flatnonzero(np.isfinite(flat))
        if cell.size == 0:
            raise Error("nothing burns in it: no cell has a time of arrival")
        cell = cell[np.argsort(flat[cell], kind="stable")]
        lasts = np.broadcast_to(burn_out, np.shape(arrival)).ravel()[cell].astype(np.float64)
        first, end = min(0.0, float(flat[cell[0]])), float((flat[cell] + lasts).max())
        span = end - first
        step = interval or next((each for each in _STEPS if span / each <= _FRAMES), span / _FRAMES)
        count = int(np.ceil(end / step) - np.floor(first / step))
        if count > _MOST:
            raise Error(f"--interval: {count} times would be made, {_MOST} at most are; take a longer one")
        times = np.floor(first / step) * step + step * np.arange(count + 1)
        rows, columns = np.shape(arrival)
        return cls(
            (rows, columns),
            times,
            cell,
            flat[cell],
            np.asarray(heat, np.float64).ravel()[cell],
            np.maximum(lasts, 1.0),
        )

    def flux(self, index: int) -> NDArray[np.float32]:
        """Compute the mean heat flux (ny, nx), W/m2, over the interval that ends at a time."""
        mean_flux = np.zeros(self.shape, np.float32)
        if index == 0:
            return mean_flux
        before, now = self.times[index - 1 : index + 1]
        first = int(np.searchsorted(self.arrival, before - self.burn_out.max()))
        part = slice(first, int(np.searchsorted(self.arrival, now)))
        left = [np.clip(1 - (t - self.arrival[part]) / self.burn_out[part], 0, 1) ** 2 for t in (before, now)]
        mean_flux.ravel()[self.cell[part]] = self.heat[part] * (left[0] - left[1]) / (now - before)
        return mean_flux


def of_fuel(fuel: NDArray) -> NDArray[np.float64]:
    """Compute the heat per area, J/m2, of fuel (kg/m2) that burns completely."""
    return constants.HEAT_OF_COMBUSTION * np.nan_to_num(np.asarray(fuel, np.float64))


def of_intensity(
    arrival: NDArray, intensity: NDArray, speed: NDArray | None, cell: tuple[float, float]
) -> NDArray[np.float64]:
    """Compute heat per area, J/m2: fireline intensity (W/m) / rate of spread (m/s), Byram 1959.

    Without `speed`, rate of spread comes from arrival times (s) on cells (width, height) in m. Cells without
    a value take the median of the others. If a cell has more heat than an intense front releases in its
    residence time (`FRONT_HEAT`), and more than `_OUTLIER` times the median of its neighbourhood, its front
    was not as slow as arrival times say, and the larger of the two limits applies.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        heat = np.asarray(intensity, np.float64) / (spread(arrival, cell) if speed is None else speed)
    known = np.isfinite(heat) & (heat > 0)
    middle = float(np.median(heat[known])) if known.any() else 0.0
    heat = np.where(known, heat, np.where(np.isfinite(arrival), middle, 0.0))
    return np.minimum(heat, np.maximum(FRONT_HEAT, _OUTLIER * _neighbourhood(heat, heat > FRONT_HEAT)))


def _neighbourhood(heat: NDArray[np.float64], wanted: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Compute the median of the burned cells of 3 x 3 around `wanted` cells; infinite in other cells."""
    row, column = np.nonzero(wanted)
    padded = np.pad(np.where(heat > 0.0, heat, np.nan), 1, constant_values=np.nan)
    around = [padded[row + up, column + right] for up in range(3) for right in range(3)]
    result = np.full(heat.shape, np.inf)
    if len(row):
        result[row, column] = np.nanmedian(around, axis=0)
    return result


def spread(arrival: NDArray, cell: tuple[float, float]) -> NDArray[np.float64]:
    """Compute the rate of spread (m/s) in cells (width, height) in m: inverse gradient of arrival time.

    Along each axis the smaller one-sided difference counts. The larger one may come from another front or
    from a stop before the cell, which is not a slow front. Infinite for cells without neighbours.
    """
    padded = np.pad(np.asarray(arrival, np.float64), 1, constant_values=np.nan)
    here, inner = padded[1:-1, 1:-1], np.s_[1:-1]
    beside = (
        ((padded[:-2, inner], padded[2:, inner]), cell[1]),
        ((padded[inner, :-2], padded[inner, 2:]), cell[0]),
    )
    steps = [np.nan_to_num(np.fmin(*(np.abs(here - each) for each in pair))) / size for pair, size in beside]
    with np.errstate(divide="ignore"):
        return 1.0 / np.hypot(*steps)
