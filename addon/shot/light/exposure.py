"""Exposure from what a camera will see in each frame, and how dark it is there.

A picture is exposed for the geometric mean of what the meter's rays find (Reinhard et al. 2002, doi
10.1145/566654.566575, eq. 1), by part of the stops that this differs from a clear day's, so that nights stay
dark; and not so long that smoke in the light of flames burns out.
"""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from .. import sun
from ..cameras import targets
from ..cameras.path import Path
from ..shot import Shot
from ..terrain import noise
from . import exposure_meter, sky

_KEYS = 13  # at most so many moments of a shot are metered
_DAY, _CLEAR = 0.5, 0.19  # stops at a clear afternoon's geometric mean, radiance
_ADAPTATION = 0.6, 0.3  # part of the stops followed below and above that: white smoke is to be white; by eye
_WHITE = 0.55  # luminance on the picture of the brightest tenth of the glow, at most: above, AgX pales it
_AMID = 0.1  # of all of it in the mean, at most: amid smoke that glows, flames and trees must show; by eye
_LEAST, _MOST = -3.0, 4.0  # stops
_SUNLIT, _RISEN = 0.2, (-2.0, 6.0)  # darkness at most while the sun is up, and heights (degrees); by eye
_DARK = 1.4, 3.4  # stops without any flames from which, and at which, light is that of flames alone; by eye

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Metered:
    """Of k frames: stops, and darkness of the darkest camera."""

    frame: Array
    stops: Array
    darkness: Array


_known: WeakKeyDictionary[Shot, _Metered] = WeakKeyDictionary()


def at(shot: Shot, frames: NDArray) -> Array:
    """Stops (n,) at frames (n,) from 1: of the first camera, or the scene file's own where it has one."""
    given = shot.settings.light.exposure
    if given is not None:
        return np.full(np.shape(frames), float(given))
    found = _metered(shot)
    return np.interp(frames, found.frame, found.stops)


def darkness(shot: Shot, times: NDArray | float) -> Array:
    """How dark (n,) it is without flames at model times (n,), s, for the camera that has least light.

    0 by day, where sunlight drowns theirs, to 1 by night; under smoke by day little.
    """
    found = _metered(shot)
    return np.interp(times, shot.frames.first + (found.frame - 1.0) * shot.frames.step, found.darkness)


def _metered(shot: Shot) -> _Metered:
    shot = shot.full
    if shot not in _known:
        count = min(shot.frames.count, _KEYS)
        frames = np.unique(np.linspace(1, shot.frames.count, count).round())
        _known[shot] = _smooth(shot, frames)
    return _known[shot]


def _smooth(shot: Shot, frames: Array) -> _Metered:
    """Meter frames (k,), smooth over time."""
    if not shot.paths:
        clear = [exposure_meter.clear(sky.state(shot, shot.frames.time(frame))) for frame in frames]
        stops = np.array([_stops(each, np.zeros(2)) for each in clear])
        return _Metered(frames, stops, noise.smoothstep(*_DARK, stops))
    found = [[exposure_meter.measure(shot, view, int(frame)) for frame in frames] for view in shot.paths]
    suns = [_sun(shot, frame) for frame in frames]
    dark = np.array([[_dark(each[1], sun) for each, sun in zip(view, suns, strict=True)] for view in found])
    stops = np.array(
        [
            _stops(*_with_flames(all_light, level, shine, sun))
            for (all_light, level, shine), sun in zip(found[0], suns, strict=True)
        ]
    )
    return _Metered(frames, targets.smoothed(stops), targets.smoothed(dark.max(axis=0)))


def _stops(found: Array, glow: Array) -> float:
    """Stops for a picture of these radiances (n,), and of them that of smoke in the light of flames."""
    mean = np.log2(np.maximum(found, 1.0e-4)).mean()
    below = np.log2(_CLEAR) - mean
    wanted = _DAY + _ADAPTATION[0] * max(below, 0.0) + _ADAPTATION[1] * min(below, 0.0)
    bright = np.sort(glow)[-max(len(glow) // 10, 1) :].mean()
    most = min(_WHITE / max(bright, 1.0e-6), _AMID / max(glow.mean(), 1.0e-6))
    return float(np.clip(min(wanted, np.log2(most)), _LEAST, _MOST))


def _sun(shot: Shot, frame: float) -> float:
    """Height of the sun in a frame, degrees."""
    return float(sun.position(shot.run, shot.frames.time(frame))[1])


def _dark(found: Array, sun: float) -> float:
    """How dark it is where these radiances (n,) are found without flames and relief, 0 to 1.

    In the shade of a ridge a picture is exposed longer; the smoke over it is no darker. While the sun
    (degrees) is up, shaded smoke is grey: light comes in from its sunny side.
    """
    most = 1.0 - (1.0 - _SUNLIT) * float(noise.smoothstep(*_RISEN, sun))
    return most * float(noise.smoothstep(*_DARK, _stops(found, np.zeros(1))))


def _with_flames(found: Array, level: Array, shine: Array, sun: float) -> tuple[Array, Array]:
    """Radiances (n,) of all light and of the flames' in smoke, of what the meter measures."""
    glow = sky.glow(_dark(level, sun)) * exposure_meter.luminance(sky.GLOW) * shine
    return found + glow, glow


def radiance(shot: Shot, view: Path, frame: int) -> tuple[Array, Array]:
    """Luminances (n,) along the meter's rays in a frame: of all light, and of the flames' in smoke."""
    return _with_flames(*exposure_meter.measure(shot, view, frame), _sun(shot, frame))
