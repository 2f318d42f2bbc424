"""Flames of one frame as a volume, for the integrated renderer.

The hottest soot sets a flame's brightness in a picture, and saturates any camera. The core's luminance times
2^exposure is therefore constant, within bounds. Black bodies of 1500 to 1650 K have 8,000 to 32,000 cd/m2,
0.5 to 2 units of the scene, if 1 unit is 16,000 cd/m2. Colours are chosen for the AgX view transform: a deep
orange rim to a yellow-white core. Blue is slightly below 0, as colours of black bodies are outside of sRGB.

The heat that sets the colour sets the temperature too: 960 K in the coolest part to 1400 K in the hottest.
The infrared extinction by flame length makes the power that flames radiate `RADIATED` of the fireline
intensity. The heat account of the smoke leaves 0.3 for radiation, which includes the glowing ground.
"""

from __future__ import annotations

import numpy as np
from firetwin_core.flames import CORE_HEAT, LUMINANCE_DECADES, FlameLight, FlameShape, FlameVolume
from numpy.typing import NDArray

from ...shot.cameras.path import Path
from ...shot.fire import flame_clock, flame_library, flame_map
from ...shot.light import exposure, sky
from ...shot.shot import Shot
from ...shot.terrain import noise
from .. import infrared
from . import flames

RADIATED = 0.12  # of the heat of combustion is radiated by flames (Freeborn et al. 2008: 12 +- 3 %)
KELVIN = (960.0, 1400.0)  # K at heat 0 and 1
THICKNESS = 20.0  # visible optical depth of the sootiest gas over a flame length (by eye)
_OPAQUE = 10.0  # 1/m, most of the visible extinction: small flames are thinner (by eye)
INFRARED = ((0.5, 1.63), (1.8, 0.99), (5.0, 0.64), (18.0, 0.93), (30.0, 2.0))
"""Flame length, m, and infrared extinction of the sootiest gas, 1/m (by power, see test_flames)."""
_CORE = 1.8  # luminance of the core times 2^exposure (by eye)
_LUMINANCE = (0.15, 4.0)  # its bounds, units of the scene
GREEN = 0.04, 0.58, 2.4  # green over red: at heat 0, increase, and its exponent
_ROWS = 33
_LENGTHS = 0.2, 100.0  # m
_SOOT = 0.05  # extinction of cooled soot over the flames, over a flame's (by eye)
_ALBEDO = 0.02  # of fresh soot, which dims its own light (assumed)
_BASE = 0.22  # of burning crowns, in tree heights (assumed)
_RADIUS = 0.36  # of burning crowns, over the width of their flames (assumed)
_SPINDLES = (2000.0, 2500.0)  # m, distances between which single torching crowns give way to the front
_GROWING = (0.15, 0.6)  # parts of a torching crown's time in which it flares up, and from which it declines

Array = NDArray[np.float64]


def build(
    shot: Shot,
    path: Path,
    frame: int,
    torches: flames.Points | None,
    limit: float | None = None,
    columns: int | None = None,
) -> FlameVolume | None:
    """Build the flames that a camera may see in a frame; None if there are none.

    Parameters
    ----------
    torches
        Torching crowns of the shot.
    limit
        Distance (m) up to which flames are drawn, in all directions; None: `flame_map.reach`, in the view.
    columns
        Columns of a picture that shows their detail; None: the path's.
    """
    all_around = path.around or limit is not None
    limit = flame_map.reach(shot, path) if limit is None else limit
    if limit <= 0.0:
        return None
    time, eye = float(shot.frames.times[frame - 1]), path.position[frame - 1]
    lens = None
    if not all_around:
        lens = flame_map.ViewCone(path.rotation[frame - 1], tuple(path.halves[frame - 1]))
    pixel = 2.0 * path.halves[frame - 1][0] / (columns or path.width)
    patches = flame_map.patches(shot, eye, time, limit, pixel, lens)
    crowns = spindles(torches, time, eye) if torches is not None else np.empty((0, 6))
    if not len(crowns) and not len(patches.spacings):
        return None
    return FlameVolume(
        patches=(patches.nodes, patches.corners, patches.spacings),
        spindles=crowns,
        library=flame_library.library(),
        shape=FlameShape(wind=flame_map.carrying_wind(shot)),
        light=light(shot, frame, float(eye[2])),
        pixel=pixel,
        fade=[part * limit for part in flame_map.FADE],
        origin=eye,
        time=flame_clock.time(shot.frames, time),
    )


def light(shot: Shot, frame: int, height: float) -> FlameLight:
    """Return the light of flames in a frame, for a camera at a scene height (m)."""
    stops = float(exposure.at(shot, np.array([frame]))[0])
    state = sky.state(shot, float(shot.frames.times[frame - 1]))
    sun = state.power * np.array(state.colour) / (4.0 * np.pi)
    return FlameLight(
        visible=visible(core_luminance(stops)),
        soot=_SOOT,
        soot_light=_ALBEDO * (state.around + sun),
        coolest=KELVIN[0],
        hottest=KELVIN[1],
        extinction=extinctions(),
        dim=infrared.air_depth(shot, height),
    )


def extinctions() -> Array:
    """Return rows (n, 3) of flame length, m, and visible and infrared extinction, 1/m."""
    length = np.geomspace(_LENGTHS[0], _LENGTHS[1], _ROWS)
    visible = np.minimum(THICKNESS / length, _OPAQUE)
    return np.column_stack([length, visible, np.interp(length, *np.transpose(INFRARED))])


def core_luminance(stops: float) -> float:
    """Return the luminance of a flame's core at an exposure (stops)."""
    return float(np.clip(_CORE * 2.0**-stops, *_LUMINANCE))


def visible(core: float) -> Array:
    """Return the radiance (n, 3) at evenly spaced heats, for a luminance of the core."""
    heat = np.linspace(0.0, 1.0, _ROWS)
    colour = np.stack(
        [np.ones(_ROWS), GREEN[0] + GREEN[1] * heat ** GREEN[2], -0.06 * (1.0 - heat**3) + 0.03 * heat**4],
        axis=-1,
    )
    over = heat - CORE_HEAT
    return (core * 10.0 ** np.minimum(LUMINANCE_DECADES[0] * over, LUMINANCE_DECADES[1] * over))[
        :, None
    ] * colour


def spindles(torches: flames.Points, time: float, eye: Array) -> Array:
    """Return the crowns (n, 6) in flames near the camera at a time (s): spindles of a `FlameVolume`."""
    lit = torches.take(torches.lit(time))
    away = np.linalg.norm(lit.position - eye, axis=-1)
    near, away = lit.take(np.flatnonzero(away < _SPINDLES[1])), away[away < _SPINDLES[1]]
    part = (time - near.arrival_time) / near.residence
    up, down = np.clip(part / _GROWING[0], 0.0, 1.0), np.clip((1.0 - part) / (1.0 - _GROWING[1]), 0.0, 1.0)
    grown = np.minimum(up * (2.0 - up), down) * (1.0 - noise.smoothstep(*_SPINDLES, away))
    kept = grown > 0.1
    top = near.crown * _BASE + (near.length - near.crown * _BASE) * grown
    rows = np.column_stack([near.position, _BASE * near.crown, top, _RADIUS * near.width])
    return rows[kept]
