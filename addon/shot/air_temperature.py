"""Temperature of the air near the ground: that of the run, or an assumed day where it has none."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from firetwin_core import sensor
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from . import sun
from .fire import emissions
from .settings.protocols import Frames

PULSE = emissions.KINDS[emissions.LITTER].residence  # s that the front heats the ground under timber
COOLING = 2.0 * 20_000.0 / (600.0 * np.sqrt(np.pi))
"""K s-1/2: q = 20 kW/m2, and the thermal effusivity e = 600 J m-2 K-1 s-1/2 of dry soil (assumed)."""

BARE = 30.0  # W m-2 K-1 that bare ground passes on (assumed)
ABSORBED, LOSS = 0.85, 70.0  # part of sunlight; W/m2 of net long-wave radiation into a clear sky (assumed)
SKY = 250.0  # K, brightness temperature of a clear sky (assumed, the same all over)
STONE = 0.94  # emissivity of stone, the least of any ground (assumed)

_FIRE = 1.0  # W/m2; less is no fire (see `firetwin_core.flux.at_time`)
LAPSE = 6.5e-3  # K/m, the standard atmosphere
_SAMPLES = 25  # times of a shot at most at which its air is looked at
_AVERAGED = 600.0  # s
_DAY, _NIGHT = 304.0, 292.0  # K at sea level under a sun 20 degrees high, and without one (assumed)

Array = NDArray[np.float64]


def at(run: Run, time: float) -> Array:
    """(ny, nx) K at a model time (s), linear between the run's times and held beyond them."""
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
    """(ny, nx) K, mean over the run's times from `start` to `end` (s), or at `end` where there is none."""
    inside = np.flatnonzero((run.times >= start) & (run.times <= end))
    if len(inside) == 0 or not run.has("temperature"):
        return at(run, end)
    total = np.zeros((len(run.latitude), len(run.longitude)))
    for index in inside:
        total += _filled(run.temperature(int(index)))
    return total / len(inside)


def warmth(run: Run, start: float, end: float) -> tuple[Array, float]:
    """(ny, nx) K that mean air from `start` to `end` (s) is warmer than unburned air as high, and the noise.

    Unburned air is a straight line through temperature against the model's elevation, by least squares over
    the cells without heat flux in that time: height and time of day are not warmth. A hundredth of those
    cells lie above the noise (K), as beside the fire and where wind and slope make other air.
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
    """K that a tenth of the run's air is colder than at a time (s)."""
    return float(np.percentile(at(run, time), 10.0))


def coldest_ground(run: Run, time: float, band: tuple[float, float]) -> float:
    """Brightness temperature (K) over a band (um) of the coldest that level ground or air is at a time (s).

    Air is that of `coldest`. Level bare ground is warmer by what the sun gives it over what it loses, as in
    the thermal view: by night 2.3 K colder. Stone, which mirrors 6 % of the cold sky, looks colder still, by
    2 K between 8 and 14 um. Under a sun higher than some ten degrees the air is the coldest.
    """
    air, (_, height) = coldest(run, time), sun.position(run, time)
    ground = air + (ABSORBED * sun.direct(height) * np.sin(np.radians(height)) - LOSS) / BARE
    seen = STONE * sensor.radiance(ground, band) + (1.0 - STONE) * sensor.radiance(SKY, band)
    return min(air, float(sensor.brightness_temperature(seen, band)))


class OverShot:
    """The run's air over the frames of a shot: what scales of pictures need to know of all of it.

    Attributes
    ----------
    averaged
        Seconds over which the model's temperature is averaged: ten minutes, or from frame to frame.
    """

    def __init__(self, run: Run, frames: Frames) -> None:
        self._run = run
        self._times = np.linspace(frames.first, frames.last, min(_SAMPLES, frames.count))
        self.averaged = max(_AVERAGED, frames.step)

    @cached_property
    def coldest(self) -> float:
        """K that a tenth of the run's air is colder than, in the coldest of 25 times of the shot."""
        return min(coldest(self._run, float(time)) for time in self._times)

    @cached_property
    def warmest(self) -> tuple[float, float]:
        """K that the air the fire warms is over unburned air, least and most, in 25 times of the shot."""
        found = [warmth(self._run, time - self.averaged, time) for time in self._times]
        low, high = max(noise for _, noise in found), max(float(above.max()) for above, _ in found)
        return low, max(high, low + 1.0)


def cooling(age: ArrayLike, pulse: ArrayLike = PULSE) -> Array:
    """K that ground is warmer `age` s after the front came than it was, without flames or embers.

    That of a thick body which took in a flux q for the time p, `pulse` (H. S. Carslaw and J. C. Jaeger 1959,
    "Conduction of Heat in Solids", 2.9): 2 q / (e sqrt(pi)) (sqrt(t) - sqrt(t - p)).
    """
    age = np.maximum(np.asarray(age, np.float64), 0.0)
    return COOLING * (np.sqrt(age) - np.sqrt(np.maximum(age - pulse, 0.0)))


def indices(run: Run, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
    """Fractional row and column of the run's grid at places (degrees), held inside it."""
    return index(run.latitude, latitude), index(run.longitude, longitude)


def index(axis: NDArray, value: ArrayLike) -> Array:
    """Fractional index of values on an axis that rises or falls, held inside it."""
    order = slice(None, None, -1) if axis[0] > axis[-1] else slice(None)
    return np.interp(
        np.asarray(value, np.float64), axis[order], np.arange(len(axis), dtype=np.float64)[order]
    )


def _filled(field: NDArray) -> Array:
    """A field with its mean where it is not known."""
    known = np.isfinite(field)
    field = field.astype(np.float64)
    return field if known.all() else np.where(known, field, field[known].mean() if known.any() else _DAY)
