"""Tint the ground by members of a forecast, and draw their fronts (see `shot.passes.forecast`)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ...imaging import split_screen
from ...run.ensemble.places import Places
from ...shot import forecast, picture_credits
from ...shot.cameras import pixel_rays
from ...shot.shot import Shot
from .. import composite
from . import Files, _forecast_text

_TINT = 0.7  # opacity of the tint (by eye)
_FEW, _MANY = 0.1, 1.0  # strength of the tint for the fewest and the most members (by eye)
_GREY = 0.8  # factor on the grey picture's brightness below it (by eye)
_LINE = 0.8  # opacity of a line (by eye)
_HATCH, _PERIOD = 0.35, 45  # opacity of hatching (by eye); its lines are height / _PERIOD apart
_JUMP = 1.3  # ratio of distances in a 3 x 3 neighbourhood from which on it is the edge of a hill or tree
_SEEN = 1e-3  # share of the picture from which on hatching is explained

Array = NDArray[np.float32]


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Draw the forecast."""
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    points = pixel_rays.points(pixel_rays.path_of(shot.paths, camera), frame, planar)
    found = forecast.of(shot.settings)
    shown = forecast.member_of(shot.settings, shot.run, first="@" not in camera)
    time = (shot.utc(frame) - found.issued).total_seconds()
    counted = np.flatnonzero(found.counted(time))
    drawn = [m for m in forecast.others(found, shown, shot.settings.forecast.lines) if m in counted]
    ground = np.isfinite(points).all(axis=-1)
    latitude, longitude, _ = shot.local_frame.reverse(points[ground])
    places = Places(found, latitude, longitude)

    def picture(values: NDArray) -> NDArray:
        full = np.zeros(ground.shape, values.dtype)
        full[ground] = values
        return full

    known, clear = places.simulated(counted), clearness(sensor.read_channels(needed["comp"]["exr"]))
    flat, lines = smooth_ground(planar), np.zeros(ground.shape, np.float32)
    counts, mine = np.zeros(len(known), np.int64), lines
    for member in counted if shot.settings.forecast.shares else {shown, *drawn}:
        burned = places.burned(int(member), time)
        counts += burned
        if member == shown:
            mine = outline(picture(burned)) * flat
        elif member in drawn:
            lines = np.maximum(lines, outline(picture(burned)) * flat)
    if shot.settings.forecast.shares:
        kinds = classes(picture(np.where(known, counts, 0)), len(counted))
        rgb = tint(rgb, kinds, palette(len(counted)), clear)
    rgb = over(rgb, _forecast_text.LINE, _LINE * clear * lines)
    rgb = over(rgb, _forecast_text.SHOWN, clear * mine)
    unknown = picture(~known)
    rgb = over(rgb, _forecast_text.HATCH, _HATCH * clear * (unknown & stripes(*rgb.shape[:2])))
    keys = _forecast_text.legend(
        shot, found, frame, shown, counted, len(drawn), float(unknown.mean()) > _SEEN
    )
    said = _forecast_text.caption(shot, found, frame, shown)
    height, width = rgb.shape[:2]
    below = picture_credits.foot(shot, width, height)
    sensor.write_image(files["png"], split_screen.sheet([rgb], [keys], said, below))


def palette(members: int) -> tuple[str, ...]:
    """Choose the colours of the classes, fewest members first: five, or one for each of fewer members."""
    return _forecast_text.COLOURS[: max(min(members, len(_forecast_text.COLOURS)), 1)]


def classes(counts: NDArray[np.int64], members: int) -> NDArray[np.int64]:
    """Classify counts of members: 0 for none, else 1 to the number of classes, each as wide as the others."""
    return -(-counts * len(palette(members)) // max(members, 1))


def clearness(layers: Mapping[str, Array]) -> Array:
    """Compute the share (h, w) of the picture's light that comes from ground that is not burning."""
    light = sum(layers[f"{name}.{c}"] for name in ("fire", "light_fire") for c in "RGB")
    every = sum(np.maximum(layers[c], 0.0) for c in "RGB")
    burning = np.clip(light / np.maximum(every, 1e-6), 0.0, 1.0)
    return (np.clip(1.0 - layers["smoke.A"], 0.0, 1.0) * (1.0 - burning)).astype(np.float32)


def tint(rgb: Array, kinds: NDArray[np.int64], colours: tuple[str, ...], clear: Array) -> Array:
    """Tint a picture (h, w, 3) by classes (h, w) of these colours, over its grey; class 0 stays.

    The tint is stronger for more members, so that ground that few burn does not stand out.
    """
    grey = _GREY * (rgb @ np.array([0.2126, 0.7152, 0.0722], np.float32))[..., None]
    shades = np.array([[0.0] * 3, *map(_values, colours)], np.float32)[kinds]
    mixed = grey * (1.0 - _TINT) + shades * _TINT
    strength = np.array([0.0, *np.linspace(_FEW, _MANY, len(colours) + 1)[1:]], np.float32)[kinds]
    share = (clear * strength)[..., None]
    return rgb * (1.0 - share) + mixed * share


def over(rgb: Array, colour: str, opacity: Array) -> Array:
    """Draw a colour over a picture with an opacity (h, w)."""
    return rgb + (np.array(_values(colour), np.float32) - rgb) * opacity[..., None]


def outline(burned: NDArray[np.bool_]) -> Array:
    """Draw the border of an area (h, w) as a smooth line about 2 pixels wide: opacity, 0 to 1."""
    share = composite.blur(burned[..., None].astype(np.float32))[..., 0]
    return np.sqrt(4.0 * share * (1.0 - share))


def smooth_ground(planar: Array) -> NDArray[np.bool_]:
    """Find pixels (h, w) away from the edges of hills and trees, where a border is not a front."""
    nearest = -composite.greatest_near(-planar)
    return composite.greatest_near(planar) < _JUMP * nearest


def stripes(height: int, width: int) -> NDArray[np.bool_]:
    """Draw diagonal lines over a picture (h, w)."""
    period = max(height // _PERIOD, 4)
    row, column = np.indices((height, width))
    return (row + column) % period < max(period // 4, 1)


def _values(colour: str) -> tuple[float, ...]:
    """Convert a colour such as ``#ff8000`` to three values 0 to 1, display-referred as the picture is."""
    return tuple(int(colour[at : at + 2], 16) / 255.0 for at in (1, 3, 5))
