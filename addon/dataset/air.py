"""Air and moon of a sample: haze, fog and dust from its meteorological visibility. Needs no Blender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..run.sun import Moon
from ..shot.light import sky
from .draw import Draw

_KOSCHMIEDER = 3.912  # optical depth at which a contrast of 1 falls to 2 % (WMO-No. 8)
_PARTS = (np.arange(16) + 0.5) / 16  # of a line of sight, at which its air is measured
_FOG_SUN, _DUST_SUN = 0.12, 0.45  # share of direct sunlight that passes (by eye)
_MOON = 15.0, 65.0  # degrees, elevations of the moon (assumed)
_FOG_SOFT = 40.0  # degrees, angle over which the sun spreads in fog (by eye)


@dataclass(frozen=True)
class Air:
    """Look of the air.

    Attributes
    ----------
    tint
        Factors on the airlight in red, green and blue.
    grey
        Share of the airlight that is grey: droplets scatter all colours equally.
    sun
        Share of direct sunlight that reaches the ground.
    soft
        Least angle over which the sun spreads, degrees.
    """

    tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    grey: float = 0.0
    sun: float = 1.0
    soft: float = 0.0


_LOOKS = {
    "fog": Air(grey=1.0, sun=_FOG_SUN, soft=_FOG_SOFT),
    "dust": Air((1.0, 0.80, 0.55), grey=0.6, sun=_DUST_SUN, soft=10.0),
}  # colours by eye


def look(drawn: Draw) -> Air:
    """Return the look of a sample's air; clouds take their share of the sunlight."""
    found = _LOOKS.get(drawn.kind, Air())
    covered = drawn.cloud_cover if drawn.kind == "cloud" else 0.0
    return Air(found.tint, found.grey, found.sun * (1.0 - 0.9 * covered**2), max(found.soft, 30.0 * covered))


def haze_amount(drawn: Draw) -> float:
    """Compute `light.haze` so that the visibility at the lower of camera and target is the drawn one.

    Extinction is 3.912 over the visibility (Koschmieder 1924). It falls with height as in `shot.light.sky`.
    """
    low = np.array(min(drawn.camera.position[2], drawn.target[2]))
    return float(_KOSCHMIEDER / (1000.0 * drawn.visibility) / _extinction(1.0, low))


def clearness(haze: float, start: NDArray[np.float64], ends: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the share (n,) of light that the air lets pass from points (n, 3) to a point (3,), m."""
    along = start + _PARTS[:, None, None] * (ends - start)
    mean: NDArray[np.float64] = _extinction(haze, along[..., 2]).mean(axis=0)
    return np.exp(-mean * np.linalg.norm(ends - start, axis=-1))


def _extinction(haze: float, height: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the extinction of air, 1/m, at heights in the scene, m."""
    low = sky.LOW_HAZE * np.exp(-height / sky.LOW_HEIGHT)
    return np.asarray(haze * sky.HAZE * (np.exp(-height / sky.HAZE_HEIGHT) + low))


def moon(drawn: Draw) -> Moon:
    """Draw a moon above the horizon: from none to full, with equal density of its light."""
    random = np.random.default_rng(drawn.random_seed("moon"))
    bearing, height, light = random.uniform((0.0, _MOON[0], 0.0), (360.0, _MOON[1], 1.0))
    return Moon(float(bearing), float(height), float(light))
