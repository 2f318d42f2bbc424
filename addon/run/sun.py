"""Solar and lunar position, and irradiance of sun and moon, at a place and time."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

import numpy as np
from astral import Observer
from astral import moon as lunar
from astral.sun import azimuth, elevation
from firetwin_core.run import Run
from numpy.typing import NDArray

from . import times

NIGHT = -1.0  # degrees, solar elevation below which the moon shines
_STARS = (150.0, 40.0)  # degrees, bearing and elevation of the residual light on a night without moon
_MONTH = 28.0  # days, cycle of astral's moon phase
_HAZE = 0.2  # optical depth of the atmosphere for moonlight, at the zenith (assumed)


@dataclass(frozen=True)
class Moon:
    """Moon: bearing and elevation (degrees), and irradiance relative to a full moon at normal incidence."""

    bearing: float
    height: float
    light: float


NO_MOON = Moon(*_STARS, 0.0)


def angles(latitude: float, longitude: float, moment: datetime) -> tuple[float, float]:
    """Compute the solar bearing, clockwise from north, and elevation with refraction, degrees (NOAA)."""
    observer = Observer(latitude, longitude, 0.0)
    return azimuth(observer, moment), elevation(observer, moment)


def air_mass(height: float) -> float:
    """Compute the relative air mass at a solar elevation (degrees), 1 at zenith (Kasten and Young 1989)."""
    return float(1.0 / (np.sin(np.radians(height)) + 0.50572 * (height + 6.07995) ** -1.6364))


def direct(height: float) -> float:
    """Compute the direct normal irradiance (W/m2) at a solar elevation (degrees); 0 below the horizon.

    1353 x 0.7^(m^0.678) through m masses of air (A. B. Meinel and M. P. Meinel 1976, "Applied Solar Energy").
    """
    return float(1353.0 * 0.7 ** (air_mass(height) ** 0.678)) if height > 0.0 else 0.0


def direction(bearing: float, height: float) -> NDArray[np.float64]:
    """Compute the unit vector (east, north, up) towards a bearing and height in degrees."""
    bearing, height = np.radians(bearing), np.radians(height)
    return np.array([np.sin(bearing) * np.cos(height), np.cos(bearing) * np.cos(height), np.sin(height)])


def shadow_direction(bearing: float, height: float, night: Moon = NO_MOON) -> NDArray[np.float64]:
    """Compute the unit vector towards the shadow-casting light: sun at these angles (degrees), or moon."""
    if height > NIGHT:
        return direction(bearing, max(height, 0.5))
    return direction(night.bearing, night.height) if night.light > 0.0 else direction(*_STARS)


def moon(run: Run, time: float) -> Moon:
    """Compute the moon over the middle of the run's grid at a model time.

    Its light goes with the angle a (degrees) between sun and earth seen from it as 10^(-0.4 (0.026 a +
    4e-9 a^4)) (K. Krisciunas and B. E. Schaefer 1991, "A model of the brightness of moonlight", PASP 103).
    """
    moment, observer = times.utc(run, time), Observer(*_middle(run), 0.0)
    height = lunar.elevation(observer, moment)
    if height <= 0.0:
        return NO_MOON
    angle = abs(180.0 - 360.0 * lunar.phase(moment) / _MONTH)
    bright = 10.0 ** (-0.4 * (0.026 * angle + 4.0e-9 * angle**4))
    through = np.exp(-_HAZE / max(np.sin(np.radians(height)), 0.02))
    return Moon(lunar.azimuth(observer, moment), height, float(bright * through))


def position(run: Run, time: float) -> tuple[float, float]:
    """Compute the solar bearing and elevation (degrees) at the grid's centre at a model time (s)."""
    return angles(*_middle(run), times.utc(run, time))


def toward_light(run: Run, time: float) -> NDArray[np.float64]:
    """Compute the unit vector towards the sun, or at night the moon, over the run at a model time (s)."""
    return shadow_direction(*position(run, time), moon(run, time))


def _middle(run: Run) -> tuple[float, float]:
    """Return latitude and longitude of the centre of the run's grid, degrees."""
    latitude, longitude = (float(axis[0] + axis[-1]) / 2.0 for axis in (run.latitude, run.longitude))
    return latitude, longitude
