"""Air temperature near the ground: the run's, or an assumed diurnal range if it has none.

Constants and formulas of the ground's own temperature are here too: its gain of sunlight, its loss to the
sky, and how it cools after the front (`cooling`). `scene.temperature` draws with them.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from firetwin_core import sensor
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ...run import sun
from ..frames import Frames
from . import emissions

# s, time for which the front heats the ground under timber
PULSE = emissions.KINDS[emissions.LITTER].residence
COOLING = 2.0 * 20_000.0 / (600.0 * np.sqrt(np.pi))
"""K s-1/2, with q = 20 kW/m2 and the thermal effusivity e = 600 J m-2 K-1 s-1/2 of dry soil (assumed)."""

BARE = 30.0  # W m-2 K-1, heat transfer coefficient of bare ground (assumed)
# absorbed fraction of sunlight; W/m2, net long-wave loss to a clear sky (assumed)
ABSORBED, LOSS = 0.85, 70.0
SKY = 250.0  # K, brightness temperature of a clear sky (assumed, uniform)
STONE = 0.94  # emissivity of stone, the lowest of any ground (assumed)

_FIRE = 1.0  # W/m2; lower fluxes are not fire (see `firetwin_core.flux.at_time`)
LAPSE = 6.5e-3  # K/m, the standard atmosphere
TROPOPAUSE = 216.65  # K, air from 11 to 20 km in the standard atmosphere; air aloft is not colder
_SAMPLES = 25  # times of a shot at most at which its air is sampled
_AVERAGED = 600.0  # s
_DAY, _NIGHT = 304.0, 292.0  # K at sea level under a sun 20 degrees high, and without one (assumed)

Array = NDArray[np.float64]


def at(run: Run, time: float) -> Array:
    """Air temperature (ny, nx), K, at a model time (s), linear between the run's times, constant beyond."""
    if not run.has("temperature"):
        day = float(np.clip(sun.position(run, time)[1] / 20.0, 0.0, 1.0))
        return _NIGHT + day * (_DAY - _NIGHT) - LAPSE * np.nan_to_num(run.elevation.astype(np.float64))
    times = run.times
    after = int(np.clip(np.searchsorted(times, time), 1, max(len(times) - 1, 1)))
    before = after - 1
    if len(times) == 1:
        return _filled(run.temperature(0))
    part = float(np.clip((time - times[before]) / (times[after] - times[before]), 0.0, 1.0))
    return (1.0 - part) * _filled(run.temperature(before)) + part * _filled(run.temperature(after))


def mean(run: Run, start: float, end: float) -> Array:
    """Mean air temperature (ny, nx), K, over the run's times from `start` to `end` (s), or at `end` alone."""
    inside = np.flatnonzero((run.times >= start) & (run.times <= end))
    if len(inside) == 0 or not run.has("temperature"):
        return at(run, end)
    total = np.zeros((len(run.latitude), len(run.longitude)))
    for index in inside:
        total += _filled(run.temperature(int(index)))
    return total / len(inside)


def warmth(run: Run, start: float, end: float) -> tuple[Array, float]:
    """Temperature excess (ny, nx), K, of the mean air over unburned air of the same elevation, and the noise.

    Unburned air is a linear fit of temperature against the model's elevation, by least squares over the cells
    without heat flux in that time. So height and time of day do not count as excess. One percent of those
    cells exceed the noise (K), for instance next to the fire and where wind and slope alter the air.
    """
    kelvin = mean(run, start, end)
    inside = np.flatnonzero((run.times >= start) & (run.times <= end))
    calm = np.isfinite(run.elevation)
    for index in inside if len(inside) else [int(np.abs(run.times - end).argmin())]:
        calm &= ~(run.heat_flux(int(index)) >= _FIRE)
    if not calm.any():
        return np.zeros(kelvin.shape), 0.0
    height = np.nan_to_num(run.elevation.astype(np.float64))
    line = np.polynomial.Polynomial.fit(height[calm], kelvin[calm], 1 if np.ptp(height[calm]) > 1.0 else 0)
    above = kelvin - line(height)
    return above, float(np.percentile(above[calm], 99.0))


def coldest(run: Run, time: float) -> float:
    """Tenth percentile of the run's air temperature at a time (s), K."""
    return float(np.percentile(at(run, time), 10.0))


def coldest_ground(run: Run, time: float, band: tuple[float, float]) -> float:
    """Brightness temperature (K) in a band (um) of the coldest of level ground and air at a time (s).

    Air is at the temperature of `coldest`. Level bare ground is warmer by solar gain minus long-wave loss, as
    in the thermal view: by night 2.3 K colder. Stone, which reflects 6 % of the cold sky, is colder still, by
    2 K between 8 and 14 um. Under a sun above about ten degrees the air is the coldest.
    """
    air, (_, height) = coldest(run, time), sun.position(run, time)
    ground = air + (ABSORBED * sun.direct(height) * np.sin(np.radians(height)) - LOSS) / BARE
    stone = STONE * sensor.radiance(ground, band) + (1.0 - STONE) * sensor.radiance(SKY, band)
    return min(air, float(sensor.brightness_temperature(stone, band)))


class OverShot:
    """Air temperature over all frames of a shot, for the scales of pictures.

    Attributes
    ----------
    averaged
        Averaging time of the model's temperature, s: ten minutes, or the frame step if that is longer.
    """

    def __init__(self, run: Run, frames: Frames) -> None:
        self._run = run
        self._times = np.linspace(frames.first, frames.last, min(_SAMPLES, frames.count))
        self.averaged = max(_AVERAGED, frames.step)

    @cached_property
    def coldest(self) -> float:
        """Lowest tenth percentile of air temperature in up to 25 times of the shot, K."""
        return min(coldest(self._run, float(time)) for time in self._times)

    @cached_property
    def warmest(self) -> tuple[float, float]:
        """Temperature excess of air warmed by the fire, least and most, in up to 25 times of the shot, K."""
        excess = [warmth(self._run, time - self.averaged, time) for time in self._times]
        low, high = max(noise for _, noise in excess), max(float(above.max()) for above, _ in excess)
        return low, max(high, low + 1.0)


def cooling(age: ArrayLike, pulse: ArrayLike = PULSE) -> Array:
    """Temperature excess (K) of ground `age` s after the front's arrival, without flames or embers.

    Semi-infinite solid with a heat flux q for a time p, `pulse` (H. S. Carslaw and J. C. Jaeger 1959,
    "Conduction of Heat in Solids", 2.9): 2 q / (e sqrt(pi)) (sqrt(t) - sqrt(t - p)).
    """
    age = np.maximum(np.asarray(age, np.float64), 0.0)
    return COOLING * (np.sqrt(age) - np.sqrt(np.maximum(age - pulse, 0.0)))


def indices(run: Run, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
    """Fractional row and column of the run's grid at points (degrees), clamped to it."""
    return index(run.latitude, latitude), index(run.longitude, longitude)


def index(axis: NDArray, value: ArrayLike) -> Array:
    """Fractional index of values on an ascending or descending axis, clamped to it."""
    order = slice(None, None, -1) if axis[0] > axis[-1] else slice(None)
    return np.interp(
        np.asarray(value, np.float64), axis[order], np.arange(len(axis), dtype=np.float64)[order]
    )


def _filled(field: NDArray) -> Array:
    """Fill NaN of a field by its mean."""
    known = np.isfinite(field)
    field = field.astype(np.float64)
    return field if known.all() else np.where(known, field, field[known].mean() if known.any() else _DAY)
