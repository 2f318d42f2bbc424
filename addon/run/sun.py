"""Solar and lunar position, and irradiance of sun and moon, at a place and time."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator
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
_PARALLAX = 0.951  # degrees, mean horizontal parallax of the moon
_HAZE = 0.2  # optical depth of the atmosphere for moonlight, at the zenith (assumed)


@dataclass(frozen=True)
class Moon:
    """Moon: bearing and elevation (degrees), and irradiance relative to a full moon at normal incidence."""

    bearing: float
    height: float
    light: float


NO_MOON = Moon(*_STARS, 0.0)


_fixed: list[tuple[tuple[float, float], Moon]] = []


@contextlib.contextmanager
def fixed(bearing: float, height: float, moon: Moon = NO_MOON) -> Iterator[None]:
    """Fix the sun of all runs at a bearing and elevation (degrees), and the moon, during a `with` block.

    Samples of a data set draw the sun independently of the date.
    """
    _fixed.append(((bearing, height), moon))
    try:
        yield
    finally:
        _fixed.pop()


@functools.lru_cache(maxsize=1024)
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
    a is 180 degrees less the elongation, since the sun is far behind the moon.
    """
    if _fixed:
        return _fixed[-1][1]
    moment, place = times.utc(run, time), middle(run)
    bearing, height = moon_angles(*place, moment)
    if height <= 0.0:
        return NO_MOON
    angle = 180.0 - elongation(*place, moment)
    bright = 10.0 ** (-0.4 * (0.026 * angle + 4.0e-9 * angle**4))
    through = np.exp(-_HAZE / max(np.sin(np.radians(height)), 0.02))
    return Moon(bearing, height, float(bright * through))


@functools.lru_cache(maxsize=1024)  # `moon` asks twice, and each view of a film again
def moon_angles(latitude: float, longitude: float, moment: datetime) -> tuple[float, float]:
    """Compute the moon's bearing, clockwise from north, and elevation, degrees, within 0.1.

    The elevation is lower by the parallax at a place on the ground than from the Earth's centre.
    """
    observer = Observer(latitude, longitude, 0.0)
    height = lunar.elevation(observer, moment)
    return lunar.azimuth(observer, moment), float(height - _PARALLAX * np.cos(np.radians(height)))


def elongation(latitude: float, longitude: float, moment: datetime) -> float:
    """Compute the angle between moon and sun, degrees."""
    toward = [direction(*each(latitude, longitude, moment)) for each in (angles, moon_angles)]
    return float(np.degrees(np.arccos(np.clip(toward[0] @ toward[1], -1.0, 1.0))))


def toward_moon(run: Run, time: float) -> NDArray[np.float64]:
    """Compute the unit vector towards the moon over the run at a model time (s), also below the horizon."""
    return direction(*moon_angles(*middle(run), times.utc(run, time)))


def position(run: Run, time: float) -> tuple[float, float]:
    """Compute the solar bearing and elevation (degrees) at the grid's centre at a model time (s)."""
    if _fixed:
        return _fixed[-1][0]
    return angles(*middle(run), times.utc(run, time))


def toward_light(run: Run, time: float) -> NDArray[np.float64]:
    """Compute the unit vector towards the sun, or at night the moon, over the run at a model time (s)."""
    bearing, height = position(run, time)
    return shadow_direction(bearing, height, NO_MOON if height > NIGHT else moon(run, time))


def middle(run: Run) -> tuple[float, float]:
    """Return latitude and longitude of the centre of the run's grid, degrees."""
    latitude, longitude = (float(axis[0] + axis[-1]) / 2.0 for axis in (run.latitude, run.longitude))
    return latitude, longitude
