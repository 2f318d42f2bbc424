"""Ambient atmosphere of a smoke flow: profiles of wind, temperature and humidity. Needs no Blender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ..shot.terrain import noise

WIND = 0.75  # factor on the run's near-surface wind, which includes the fire's own inflow (assumed)
_SHEAR = 0.1  # exponent of the wind power law, over rough ground by day
_VEER = 10.0, 4000.0  # degrees of veering to the right, up to this height, m
_VEER_LIMIT = 1.2  # times that height, above which the wind direction is constant
_MIXED_THETA = (
    312.0  # K, potential temperature of the mixed layer: 27 degrees C over ground at 1200 m (assumed)
)
_MIXED = 3300.0  # m, mixed layer of a dry September day (assumed)
# K/m, potential temperature gradient: mixed layer, free atmosphere, nocturnal valley inversion
_DAY, _ALOFT, _NIGHT = 0.3e-3, 4.5e-3, 12e-3
STABILITY = (
    constants.GRAVITY / _MIXED_THETA * _DAY
)  # 1/s2, squared buoyancy frequency of the daytime mixed layer
_INVERSION = 600.0  # m, depth of the inversion (assumed)
_HEIGHTS = np.array([0.0, 10, 30, 100, 300, 600, 1000, 1800, 2600, 3300, 4000, 4800, 6000, 9000])
# m, kg/kg: water vapour at a fifth of saturation at the ground, constant in the mixed layer, less above
# (assumed)
_WATER = [0.0, 3300.0, 4500.0, 9000.0], [5.2e-3, 5.2e-3, 1.5e-3, 0.1e-3]
_TURN = -10.0, 2.0  # degrees, solar elevations between which night turns into day
_MAX_HUMIDITY = 0.8  # upper limit of relative humidity: the sky is clear (assumed)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Air:
    """Atmospheric profile at heights (n,), m above ground, for `firetwin_core.flow.Profile`."""

    height: Array
    potential_temperature: Array
    water: Array
    pressure: float  # Pa, at height 0


def air(sun: float, ground: float) -> Air:
    """Estimate the atmosphere for the elevation of the sun (degrees) and the mean ground height (m)."""
    day = float(noise.smoothstep(*_TURN, sun))
    low = np.exp(np.log(_NIGHT) + day * (np.log(_DAY) - np.log(_NIGHT)))
    gradient = np.where(
        _HEIGHTS[1:] <= _INVERSION, low, np.where(_HEIGHTS[1:] <= _MIXED, _DAY + (1 - day) * 2.7e-3, _ALOFT)
    )
    warmer = np.concatenate([[0.0], np.cumsum(gradient * np.diff(_HEIGHTS))])
    # at night the ground layer is colder; air aloft is unchanged
    theta = _MIXED_THETA + warmer - np.interp(_MIXED, _HEIGHTS, warmer)
    water = np.minimum(
        np.interp(_HEIGHTS, *_WATER), _MAX_HUMIDITY * _saturation(theta, _pressure(ground + _HEIGHTS))
    )
    return Air(_HEIGHTS, theta, water, float(_pressure(ground)))


def _pressure(height: Array | float) -> Array | float:
    """Return pressure, Pa, at heights above the sea, m, in the International Standard Atmosphere."""
    return 101325.0 * np.maximum(1.0 - 2.25577e-5 * np.asarray(height), 0.0) ** 5.25588


def _saturation(potential_temperature: Array, pressure: Array | float) -> Array:
    """Return the saturation mixing ratio, kg/kg, by Magnus' formula (cpp/flow/thermodynamics.hpp)."""
    celsius = potential_temperature * (pressure / 1e5) ** 0.2857 - 273.15
    vapour = 610.94 * np.exp(17.625 * celsius / (celsius + 243.04))
    return 0.622 * vapour / (pressure - 0.378 * vapour)


def wind(near_ground: tuple[float, float]) -> Array:
    """Return the wind profile (n, 2), m/s, from the wind at 10 m: a power law that veers with height."""
    speed = WIND * np.hypot(*near_ground) * (np.maximum(_HEIGHTS, 10.0) / 10.0) ** _SHEAR
    degrees, height = _VEER
    turned = np.radians(degrees) * np.clip(_HEIGHTS / height, 0.0, _VEER_LIMIT)
    angle = np.arctan2(near_ground[1], near_ground[0]) - turned
    return np.stack([speed * np.cos(angle), speed * np.sin(angle)], axis=-1)
