"""Weather of the sample run: an invented dry day of south-west wind, and the effect of canyons on it.

Times are seconds since the run's start, 16 September 2014 21:45 PDT; the days before have the same weather.
NumPy only: the expansion of the sample uses it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Hours since the start, 10 m wind speed (m/s) and the direction it blows from (degrees), air temperature at
# 1200 m (degrees C), relative humidity (%). 17 September 13:00 PDT is hour 15.25; its afternoon was hot, dry
# and windy.
_SCHEDULE = np.array(
    [
        [0.0, 2.4, 235, 20.0, 34],
        [3.0, 1.8, 230, 17.5, 42],
        [6.0, 1.6, 225, 16.0, 47],
        [9.0, 1.8, 225, 15.0, 50],
        [11.0, 2.6, 228, 19.0, 40],
        [13.0, 4.2, 230, 24.5, 28],
        [15.25, 7.2, 230, 29.0, 19],
        [17.5, 9.2, 231, 30.5, 15],
        [19.5, 9.6, 231, 29.5, 15],
        [21.25, 7.8, 231, 26.5, 18],
        [23.0, 4.6, 229, 23.0, 22],
        [26.0, 3.4, 227, 20.5, 26],
        [29.0, 2.8, 225, 19.0, 30],
        [31.0, 2.5, 225, 18.0, 33],
    ]
)
REFERENCE_HEIGHT = 1200.0  # m
LAPSE_RATE = 0.0065  # K/m, the standard atmosphere's


class Channel(NamedTuple):
    """Effect of the land on the wind, on the model grid (ny, nx).

    `east`, `north`: unit vector along the valley. `along`: 0 in the open to 1 in a canyon that turns the
    wind. `exposure`: factor on speed, above 1 on ridges and below in sheltered places.
    """

    east: NDArray[np.float64]
    north: NDArray[np.float64]
    along: NDArray[np.float64]
    exposure: NDArray[np.float64]


def _at(time: ArrayLike, column: int) -> NDArray[np.float64]:
    hours = np.asarray(time, dtype=float) / 3600
    return np.interp(np.where(hours < 0.0, hours % 24.0, hours), _SCHEDULE[:, 0], _SCHEDULE[:, column])


def open_wind(time: ArrayLike) -> tuple[NDArray, NDArray]:
    """Eastward and northward 10 m wind (m/s) over open ground."""
    speed, origin = _at(time, 1), np.radians(_at(time, 2))
    return -speed * np.sin(origin), -speed * np.cos(origin)


def temperature(time: ArrayLike, elevation: ArrayLike) -> NDArray[np.float64]:
    """Air temperature (K) near the ground at `elevation` (m)."""
    return _at(time, 3) + 273.15 - LAPSE_RATE * (np.asarray(elevation) - REFERENCE_HEIGHT)


def dead_fuel_moisture(time: ArrayLike) -> NDArray[np.float64]:
    """Moisture of fine dead fuel, kg water per kg dry fuel: the equilibrium moisture content.

    Simard (1968), The moisture content of forest fuels I, Canada FF-X-14, for T in degrees F and H in
    percent.
    """
    fahrenheit, humidity = _at(time, 3) * 1.8 + 32, _at(time, 4)
    middle = 2.22749 + 0.160107 * humidity - 0.01478 * fahrenheit
    damp = 21.0606 + 0.005565 * humidity**2 - 0.00035 * humidity * fahrenheit - 0.483199 * humidity
    return np.where(humidity < 50, middle, damp) / 100


def channelled(east: float, north: float, channel: Channel) -> tuple[NDArray, NDArray]:
    """Compute the wind over the land: canyons turn it along their axis and accelerate it along the axis."""
    speed = np.hypot(east, north)
    forward = east * channel.east + north * channel.north
    fit = np.abs(forward) / max(speed, 1e-9)
    gain = channel.exposure * (1 + 0.45 * channel.along * fit**2)
    keep = 1 - 0.8 * channel.along
    turn = 0.8 * channel.along * np.where(fit > 0, np.sign(forward), 0) * (0.45 + 0.55 * fit) * speed
    return gain * (keep * east + turn * channel.east), gain * (keep * north + turn * channel.north)
