"""Sun, moon, sky and haze light by solar position. Needs no Blender.

Light is in picture units: a sun of 9 W/m2 at an elevation of 38 degrees suits exposure 0.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...run import sun
from ..shot import Shot
from ..terrain import noise

Value = TypeVar("Value", float, NDArray[np.float64])

_SUN = 11.1  # W/m2 above the atmosphere
_SUN_DEPTH = np.array([0.130, 0.175, 0.2525])  # optical depth in red, green, blue of one air mass with dust
# W/m2 of a full moon, and of a moonless sky: brighter than real, for land visible near flames; by eye
_MOON, _STARS = 0.06, 0.02
# radiance added to sky and haze by a full moon, relative to a moonless sky, at dusk and by night (by eye)
_MOONLIT = 5.0, 1.5
_DISC, _SOFT = 0.53, 60.0  # degrees, width of sun and moon, and of the light of a moonless sky (by eye)
_TWILIGHT = 18.0  # degrees below the horizon at which the sun's last light has gone (astronomical twilight)
_MOON_COLOUR = (0.65, 0.78, 1.0)
NIGHT_SKY = np.array([0.009, 0.014, 0.026]) * 0.050  # radiance
DAY_SKY = np.array([0.010, 0.014, 0.024]) * 0.075  # radiance added to the sky texture by day (by eye)
_DAY_HAZE = np.array([0.54, 0.63, 0.76]) * 0.5
_DUSK_HAZE, _NIGHT_HAZE = np.array([0.35, 0.45, 0.75]) * 0.01, np.array([0.40, 0.48, 0.70]) * 0.0022
_DUSK = 0.0, -8.0  # degrees, solar elevations between which light of the dusk gives way to the night's
_FULL_DAY = 1.8  # air masses; beyond, the sun and haze in its light are redder
HAZE = 1.2e-5  # extinction at z = 0 on a dry September day, 1/m: clear mountain air
HAZE_HEIGHT = 5000.0  # m, scale height, between dust (about 2 km) and air (8 km)
LOW_HAZE = 4.0  # extinction of the boundary layer's dust and moisture at z = 0, relative to HAZE (assumed)
LOW_HEIGHT = 800.0  # m, scale height of that layer by day (assumed)
THICK_HAZE = 0.2, 1.2  # optical depths between which airlight takes the horizon's colour (by eye)

MEAN = (
    (-9.0, -6.0, -4.0, -2.0, 0.0, 2.0, 5.0, 10.0, 20.0, 34.0, 50.0, 70.0),
    (0.0, 0.0002, 0.0024, 0.014, 0.045, 0.087, 0.140, 0.194, 0.243, 0.271, 0.287, 0.297),
)
"""Solar elevations (degrees), and sky irradiance over pi, luminance, as Cycles 4.5 draws it."""

_AROUND = (
    (0.000, 0.0005, 0.0038, 0.0208, 0.0741, 0.1425, 0.2156, 0.2804, 0.3152, 0.3088, 0.2912, 0.2725),
    (0.000, 0.0004, 0.0034, 0.0181, 0.0629, 0.1366, 0.2367, 0.3334, 0.3992, 0.4099, 0.3981, 0.3801),
    (0.000, 0.0004, 0.0037, 0.0178, 0.0525, 0.1109, 0.2170, 0.3546, 0.4868, 0.5452, 0.5576, 0.5520),
)  # at the heights of MEAN, mean radiance of the same sky in red, green and blue, all parts with equal weight

_HORIZON = (
    (0.0003, 0.0032, 0.0129, 0.0497, 0.257, 0.594, 0.933, 1.163, 1.158, 1.028, 0.903, 0.788),
    (0.0001, 0.0014, 0.0055, 0.0195, 0.091, 0.299, 0.627, 0.934, 1.064, 1.020, 0.927, 0.821),
    (0.0000, 0.0003, 0.0008, 0.0021, 0.005, 0.038, 0.190, 0.448, 0.683, 0.753, 0.728, 0.664),
)  # at the heights of MEAN, radiance of the same sky 0.5 to 3 degrees above the horizon, mean of all bearings

GLOW = (1.0, 0.18, 0.027)  # colour of flame-lit smoke
_GLOW_LIGHT = 0.0172, 0.2  # luminance of that, by day and by night
# fraction of that light in thin smoke (single scattering) relative to thick smoke (multiple); by eye
THIN = 0.03
THICK = 0.004, 0.02  # extinctions (1/m) that count as thin and as thick in a model's smoke


class State:
    """Light for a sun at `bearing` and elevation `height` (degrees), and a moon.

    Attributes
    ----------
    direction
        Unit vector (east, north, up) towards the light.
    power, colour
        Irradiance (W/m2) and colour of the sun, or of the moon at night.
    width
        Angle over which the light's source spreads, degrees: light of a sky without sun and moon is soft.
    sky
        Solar elevation and bearing for the sky texture, radians.
    sky_mean
        Cosine-weighted mean radiance of the clear sky, luminance.
    around
        Unweighted mean radiance of the clear sky.
    haze
        Radiance of haze (airlight) up to some kilometres away.
    horizon
        Radiance of haze at distances where it hides the land: the sky's at the horizon.
    night
        Radiance of the sky without the sun's light, at its mean, with the moon's light in it.
    stars
        0..1, visibility of the stars in twilight (by eye).
    twilight
        Radiance of the arch of twilight above the sun, where the sky texture has already ended.
    """

    def __init__(self, bearing: float, height: float, moon: sun.Moon = sun.NO_MOON) -> None:
        self.sky = (float(np.radians(height)), float(np.radians(bearing)))
        day = float(noise.smoothstep(-1.0, 4.0, height))
        by_sun = height > sun.NIGHT
        self.direction = sun.shadow_direction(bearing, height, moon)
        sunlight = _SUN * np.exp(-_SUN_DEPTH * sun.air_mass(max(height, 0.0))) * day
        moonlight = (_STARS + (_MOON - _STARS) * moon.light) * np.array(_MOON_COLOUR)
        shining = sunlight if by_sun and day > 0.0 else moonlight
        self.power = float(shining.max())
        self.colour = shining / shining.max()
        self.width = _DISC if by_sun or moon.light > 0.0 else _SOFT
        self.haze = tuple(_haze(height, moon.light))
        bright = np.array([np.interp(height, MEAN[0], each) for each in _HORIZON])
        self.horizon = tuple(np.maximum(bright, self.haze))
        self.night = _at_dusk(DAY_SKY, NIGHT_SKY, height) * (1.0 + moon.light * _at_dusk(*_MOONLIT, height))
        self.around = np.array([np.interp(height, MEAN[0], each) for each in _AROUND]) + self.night
        self.sky_mean = float(np.interp(height, *MEAN)) + self.night.mean()
        self.stars = 1.0 - float(noise.smoothstep(-13.0, -5.0, height))
        self.twilight = _twilight(height)


def _twilight(height: float) -> float:
    """Radiance of the arch of twilight under a sun at elevation `height` (degrees).

    It halves with every 2.3 degrees to 18 degrees below the horizon, about as fast as films follow; daylight
    falls ten times as fast (by eye). The sky texture shows twilight until 8 degrees.
    """
    fallen = max(height + _TWILIGHT, 0.0)
    return float(NIGHT_SKY.mean() * np.expm1(0.3 * fallen) * (1.0 - noise.smoothstep(-8.0, -3.0, height)))


def _haze(height: float, moonlight: float) -> NDArray[np.float64]:
    """Radiance of haze under a sun at elevation `height` (degrees); half of it is skylight."""
    blue = float(noise.smoothstep(-10.0, 12.0, height))
    low = np.exp(-_SUN_DEPTH * max(sun.air_mass(max(height, 0.0)) - _FULL_DAY, 0.0))
    by_day = _DAY_HAZE * 0.5 * (1.0 + low / low.max())
    by_night = _at_dusk(_DUSK_HAZE, _NIGHT_HAZE, height) * (1.0 + moonlight * _at_dusk(*_MOONLIT, height))
    return by_night + (by_day - by_night) * blue**2


def _at_dusk(before: Value, after: Value, height: float) -> Value:
    """Interpolate from dusk to night by solar elevation `height` (degrees)."""
    return before + (after - before) * float(noise.smoothstep(*_DUSK, height))


def state(shot: Shot, time: float) -> State:
    """Light over a shot's run at a model time (s)."""
    return State(*sun.position(shot.run, time), sun.moon(shot.run, time))


def glow(darkness: float) -> float:
    """Radiance of thick smoke at 1 GW of luminous heat, in the colour GLOW; by day skylight outshines it."""
    by_day, by_night = _GLOW_LIGHT
    return by_day + (by_night - by_day) * darkness
