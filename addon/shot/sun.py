"""Where the sun is: its direction at a place and time."""

from __future__ import annotations

from datetime import datetime

import numpy as np
from astral import Observer
from astral.sun import azimuth, elevation
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..run import times

NIGHT = -1.0  # degrees of the sun under which the moon shines
_MOON = (150.0, 40.0)  # degrees of bearing and height; assumed, the moon of the night is not looked up


def angles(latitude: float, longitude: float, moment: datetime) -> tuple[float, float]:
    """Bearing clockwise from north and height over the horizon with refraction, degrees (NOAA)."""
    observer = Observer(latitude, longitude, 0.0)
    return azimuth(observer, moment), elevation(observer, moment)


def direction(bearing: float, height: float) -> NDArray[np.float64]:
    """Unit vector (east, north, up) towards a bearing and height in degrees."""
    bearing, height = np.radians(bearing), np.radians(height)
    return np.array([np.sin(bearing) * np.cos(height), np.cos(bearing) * np.cos(height), np.sin(height)])


def light(bearing: float, height: float) -> NDArray[np.float64]:
    """Unit vector towards what throws shadows: the sun at this bearing and height (degrees), or the moon."""
    return direction(bearing, max(height, 0.5)) if height > NIGHT else direction(*_MOON)


def at(run: Run, time: float) -> tuple[float, float]:
    """Bearing and height (degrees) at the middle of the run's grid at a model time (s)."""
    latitude = float(run.latitude[0] + run.latitude[-1]) / 2.0
    longitude = float(run.longitude[0] + run.longitude[-1]) / 2.0
    return angles(latitude, longitude, times.moment(run, time))
