"""Automatic exposure: stops of each frame from metered luminance, and darkness of the scene.

Exposure follows the geometric mean luminance of the meter's rays (log-average luminance; Reinhard et al.
2002, doi 10.1145/566654.566575, eq. 1). It applies a fraction of the difference in stops from a clear day, so
that nights stay dark. It is limited so that flame-lit smoke is not overexposed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...run import sun
from ..cameras import targets
from ..cameras.path import Path
from ..shot import Shot, cached_on_shot
from ..terrain import noise
from . import exposure_meter, sky

_KEYS = 13  # frames of a shot at most that are metered
_DAY, _CLEAR = 0.5, 0.19  # stops at the reference, a clear afternoon with this log-average luminance
# Fractions of the stops that exposure follows, below and above that: white smoke is to be white; by eye.
_ADAPTATION_DARK, _ADAPTATION_BRIGHT = 0.6, 0.3
_WHITE = 0.34  # largest luminance of the brightest tenth of the glow; above, AgX turns it from orange to pink
_AMID = 0.085  # largest mean of the glow over the picture: flames and trees must show in it; by eye
_LEAST, _MOST = -3.0, 4.0  # stops
_TWILIGHT = -18.0, -6.0  # degrees, solar elevations between which the limit rises by `_MORE` (by eye)
_MORE = 2.0  # stops, increase of the limit at dusk (by eye)
_SUNLIT, _RISEN = 0.2, (-2.0, 6.0)  # darkness at most while the sun is up, and heights (degrees); by eye
_DARK = 1.4, 3.4  # stops without flames at which flame light begins to dominate, and dominates fully; by eye

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Metered:
    """Metering of k frames: stops, and darkness of the darkest camera."""

    frame: Array
    stops: Array
    darkness: Array


def at(shot: Shot, frames: NDArray) -> Array:
    """Exposure in stops (n,) at frames (n,) from 1: of the first camera, or the scene file's own if set."""
    given = shot.settings.light.exposure
    if given is not None:
        return np.full(np.shape(frames), float(given))
    metered = _metered(shot.full)
    return np.interp(frames, metered.frame, metered.stops)


def middle(shot: Shot) -> float:
    """Return the exposure (stops) in the middle of a shot."""
    return float(at(shot, np.array([0.5 * (1 + shot.frames.count)]))[0])


def darkness(shot: Shot, times: NDArray | float) -> Array:
    """Darkness (n,) without flames at model times (n,), s, for the camera with the least light.

    0 by day, when sunlight outshines flames, to 1 by night; low under smoke by day.
    """
    metered = _metered(shot.full)
    return np.interp(times, shot.frames.first + (metered.frame - 1.0) * shot.frames.step, metered.darkness)


@cached_on_shot
def _metered(shot: Shot) -> _Metered:
    """Meter up to `_KEYS` frames of a full shot, and smooth the result over time."""
    frames = np.unique(np.linspace(1, shot.frames.count, min(shot.frames.count, _KEYS)).round())
    if not shot.paths:
        clear = [exposure_meter.clear(sky.state(shot, shot.frames.time(frame))) for frame in frames]
        most = [_most(_sun(shot, frame)) for frame in frames]
        stops = np.array([_stops(each, np.zeros(2), top) for each, top in zip(clear, most, strict=True)])
        return _Metered(frames, stops, noise.smoothstep(*_DARK, stops))
    metered = [[exposure_meter.measure(shot, view, int(frame)) for frame in frames] for view in shot.paths]
    suns = [_sun(shot, frame) for frame in frames]
    dark = np.array([[_dark(each[1], sun) for each, sun in zip(view, suns, strict=True)] for view in metered])
    stops = np.array(
        [
            _stops(*_with_flames(all_light, level, shine, sun), _most(sun))
            for (all_light, level, shine), sun in zip(metered[0], suns, strict=True)
        ]
    )
    return _Metered(frames, targets.smoothed(stops), targets.smoothed(dark.max(axis=0)))


def _stops(luminance: Array, glow: Array, most: float = _MOST) -> float:
    """Compute stops, up to `most`, for luminances (n,) and the glow (n,) of flame-lit smoke among them."""
    mean = np.log2(np.maximum(luminance, 1.0e-4)).mean()
    below = np.log2(_CLEAR) - mean
    wanted = _DAY + _ADAPTATION_DARK * max(below, 0.0) + _ADAPTATION_BRIGHT * min(below, 0.0)
    bright = np.sort(glow)[-max(len(glow) // 10, 1) :].mean()
    white = min(_WHITE / max(bright, 1.0e-6), _AMID / max(glow.mean(), 1.0e-6))
    return float(np.clip(min(wanted, np.log2(white)), _LEAST, most))


def _most(sun: float) -> float:
    """Return the largest stops at a solar elevation (degrees): more at dusk, so that land and smoke show."""
    dusk = noise.smoothstep(*_TWILIGHT, sun) * (1.0 - noise.smoothstep(*_RISEN, sun))
    return _MOST + _MORE * float(dusk)


def _sun(shot: Shot, frame: float) -> float:
    """Solar elevation in a frame, degrees."""
    return float(sun.position(shot.run, shot.frames.time(frame))[1])


def _dark(luminance: Array, sun: float) -> float:
    """Darkness, 0 to 1, from these luminances (n,), metered without flames and relief.

    In a ridge's shade a picture is exposed longer, but the smoke above is as bright. While the sun (elevation
    in degrees) is up, shaded smoke is grey, lit from its sunny side.
    """
    most = 1.0 - (1.0 - _SUNLIT) * float(noise.smoothstep(*_RISEN, sun))
    return most * float(noise.smoothstep(*_DARK, _stops(luminance, np.zeros(1))))


def _with_flames(luminance: Array, level: Array, shine: Array, sun: float) -> tuple[Array, Array]:
    """Luminances (n,) of all light, and of flame-lit smoke, from the meter's readings."""
    glow = sky.glow(_dark(level, sun)) * exposure_meter.luminance(sky.GLOW) * shine
    return luminance + glow, glow


def radiance(shot: Shot, view: Path, frame: int) -> tuple[Array, Array]:
    """Luminances (n,) along the meter's rays in a frame: of all light, and of flame-lit smoke."""
    return _with_flames(*exposure_meter.measure(shot, view, frame), _sun(shot, frame))
