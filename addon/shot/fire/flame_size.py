"""Flame length, tilt and temperature from fireline intensity."""

from __future__ import annotations

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

SIGHT = 12_000.0  # m; more distant fronts are drawn only as the ground's glowing edge
CROWNS = 0.1  # kg/m2, minimum canopy fuel of a crown fire (assumed)
_KELVIN = (1000.0, 1500.0)  # flames (Frankman et al. 2008)

Array = NDArray[np.float64]


def flame_length(intensity: Array, formula: str = "thomas", crowns: NDArray[np.bool_] | bool = True) -> Array:
    """Return flame length (m) from fireline intensity (kW/m).

    "thomas": 0.0266 I^(2/3) (Thomas 1963); "byram": 0.0775 I^0.46 (Byram 1959), too short for crown fire;
    "auto": Thomas for `crowns`, Byram elsewhere.
    """
    intensity = np.maximum(np.asarray(intensity, np.float64), 0.0)
    tall, low = 0.0266 * intensity ** (2.0 / 3.0), 0.0775 * intensity**0.46
    return np.where(crowns, tall, low) if formula == "auto" else tall if formula == "thomas" else low


def flame_tilt(wind: float, length: Array) -> Array:
    """Return flame tilt from the vertical (radians): tan A = 1.22 U / sqrt(g L), at most 60 (Albini 1981)."""
    return np.minimum(
        np.arctan(1.22 * wind / np.sqrt(constants.GRAVITY * np.maximum(length, 0.1))), np.pi / 3.0
    )


def flame_temperature(intensity: Array) -> Array:
    """Return flame temperature: 1000 K at 1 MW/m to 1500 K at 100 MW/m, linear in the logarithm (assumed)."""
    place = np.log10(np.maximum(intensity, 1.0) / 1.0e3) / 2.0
    return _KELVIN[0] + (_KELVIN[1] - _KELVIN[0]) * np.clip(place, 0.0, 1.0)
