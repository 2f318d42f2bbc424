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
from . import rate_of_spread

_STEPS = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600, 43200, 86400)
_FRAMES = 300
_MOST = 20_000
FRONT_HEAT = burning.CROWN_FIRE_FLUX * 120.0
"""J/m2, heat of an intense front during 120 s, the residence time of flames in timber."""
_OUTLIER = 4.0  # times the median of the neighbourhood (chosen on fires with known fuel)
_FILL = 8  # cells up to which a value is continued over cells without one
_PLATEAU = 0.1  # share of burned cells without an earlier neighbour at which times are rounded (by trial)
_NOISE = 0.25  # median difference of logarithms between neighbours (chosen on fires with known fuel)


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
    a value take the median of the others. A cell with more than `_OUTLIER` times the median of its
    neighbourhood was reached late, or its speed is nearly zero: it takes the mean of its neighbours. With the
    model's own `speed`, only if the heat is also above `FRONT_HEAT`.

    Speed and intensity vary together, so their ratio varies with the fuel alone. If neighbours differ by more
    than `_NOISE`, and by less with smoothed arrival times, the times are noisy, and the smoothed times count.
    """
    intensity, arrival = np.asarray(intensity, np.float64), np.asarray(arrival, np.float64)
    burned = np.isfinite(arrival)
    if speed is not None:
        return _without_outliers(_filled(_per_area(intensity, speed), burned), FRONT_HEAT)
    fine, smooth = (
        _per_area(intensity, of(arrival, cell))
        for of in (rate_of_spread.of_arrival, rate_of_spread.of_noisy_arrival)
    )
    noisy = _scatter(fine) >= _NOISE or np.mean(np.isfinite(fine[burned])) < 1.0 - _PLATEAU
    chosen = smooth if noisy and _scatter(smooth) < max(_scatter(fine), _NOISE) else fine
    return _without_outliers(_filled(chosen, burned), 0.0)


def _per_area(intensity: NDArray[np.float64], speed: NDArray) -> NDArray[np.float64]:
    """Compute intensity over speed, J/m2, as NaN unless it is a positive number."""
    with np.errstate(divide="ignore", invalid="ignore"):
        heat = intensity / speed
    return np.where((heat > 0.0) & np.isfinite(heat), heat, np.nan)


def _filled(heat: NDArray[np.float64], burned: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Fill burned cells without a value (NaN) with the mean of the nearest ones with a value; 0 elsewhere."""
    heat = np.where(burned, heat, np.nan)
    middle = float(np.nanmedian(heat)) if np.isfinite(heat).any() else 0.0
    for _ in range(_FILL):
        gaps = burned & ~np.isfinite(heat)
        if not gaps.any():
            break
        heat = np.where(gaps, rate_of_spread.mean_around(heat, 1), heat)
    return np.where(burned, np.where(np.isfinite(heat), heat, middle), 0.0)


def _scatter(heat: NDArray[np.float64]) -> float:
    """Return the median ratio of neighbours in a row, as the absolute difference of logarithms."""
    steps = np.abs(np.diff(np.log(heat), axis=1))
    return float(np.median(steps[np.isfinite(steps)])) if np.isfinite(steps).any() else 0.0


def _without_outliers(heat: NDArray[np.float64], trusted: float) -> NDArray[np.float64]:
    """Replace outliers by the mean of the burned cells of 3 x 3 around them that are not outliers.

    Heat (J/m2) up to `trusted` is not an outlier.
    """
    padded = np.pad(np.where(heat > 0.0, heat, np.nan), 1, constant_values=np.nan)
    outlier = np.zeros(padded.shape, bool)
    beside = (padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:])
    least = np.fmin.reduce([*beside, heat])
    row, column = np.nonzero((heat > trusted) & (heat > _OUTLIER * least))
    if len(row) == 0:
        return heat
    at = [(row + up, column + right) for up in range(3) for right in range(3)]
    limit = _OUTLIER * np.nanmedian([padded[place] for place in at], axis=0)
    outlier[row + 1, column + 1] = heat[row, column] > limit
    padded[outlier] = np.nan
    mean = np.nanmean([padded[place] for place in at], axis=0)
    result = heat.copy()
    chosen = outlier[row + 1, column + 1]
    result[row[chosen], column[chosen]] = mean[chosen]
    return result
