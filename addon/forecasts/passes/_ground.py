"""Visible picture of a member, with the ground below it as other members have burned it by then."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ...imaging.split_screen import Mark
from ...shot.cameras import pixel_rays
from ...shot.passes import Files
from ...shot.shot import Shot
from ...shot.stations import labels
from .. import forecast
from ..ensemble.places import Places
from . import _labels
from ._drawing import (
    classes,
    clearness,
    line,
    outline,
    over,
    palette,
    smooth_ground,
    stripes,
    tint,
)
from ._text import HATCH, LINE, OUTLIER, SHOWN, Counts

_HATCH = 0.35  # opacity of hatching (by eye)
_SEEN = 1e-3  # share of the picture from which on hatching is explained

Array = NDArray[np.float32]


@dataclass(frozen=True)
class Ground:
    """Picture (h, w, 3) with colours and lines, texts at places in it, and the numbers of its legend."""

    rgb: Array
    marks: list[Mark]
    counts: Counts


def draw(
    needed: Mapping[str, Files], shot: Shot, camera: str, frame: int, shown: int, others: bool = True
) -> Ground:
    """Draw colours and lines over the picture of a burning member by a shot's camera.

    Parameters
    ----------
    needed
        Files of the passes rgb, depth and comp.
    shown
        Index of the member.
    others
        Draw fronts of other members, and numbers at places.
    """
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    layers = sensor.read_channels(needed["comp"]["exr"])
    view, (height, width) = pixel_rays.path_of(shot.paths, camera), planar.shape
    points = pixel_rays.points(view, frame, planar)
    ensemble, settings = forecast.of(shot.settings), shot.settings.forecast
    time = (shot.utc(frame) - ensemble.issued).total_seconds()
    counted = np.flatnonzero(ensemble.counted(time))
    lines = forecast.others(ensemble, shown, settings.lines) if others else []
    drawn = [member for member in lines if member in counted]
    ground = np.isfinite(points).all(axis=-1)
    latitude, longitude, _ = shot.local_frame.reverse(points[ground])
    named = labels.of_forecast(shot)
    places = Places(ensemble, np.append(latitude, named.latitude), np.append(longitude, named.longitude))
    pixels = slice(None, len(latitude))

    def picture(values: NDArray) -> NDArray:
        full = np.zeros(ground.shape, values.dtype)
        full[ground] = values[pixels]
        return full

    simulated, clear, flat = places.simulated(counted), clearness(layers), smooth_ground(planar)
    counts, borders = np.zeros(len(simulated), np.int64), dict[int, Array]()
    for member in {*(counted.tolist() if settings.shares else ()), shown, *drawn}:
        burned = places.burned(member, time)
        counts += burned
        if member == shown or member in drawn:
            borders[member] = outline(picture(burned)) * flat
    if settings.shares:
        kinds = classes(picture(np.where(simulated, counts, 0)), len(counted))
        rgb = tint(rgb, kinds, palette(len(counted)), clear)
    unknown = picture(~simulated)
    rgb = over(rgb, HATCH, _HATCH * clear * (unknown & stripes(height, width)))
    outlier = forecast.outlier(ensemble)
    for member in sorted(drawn, key=lambda each: each == outlier):
        rgb = line(rgb, borders[member], OUTLIER if member == outlier else LINE, clear)
    rgb = line(rgb, borders[shown], SHOWN, clear)
    told = Counts(ensemble, shot.utc(frame), shown, len(counted), tuple(drawn), float(unknown.mean()) > _SEEN)
    seen = _labels.visible(view, frame, planar, clear, named.position)
    of = len(counted) if settings.shares and others else 0
    marks = [
        *_labels.roles(told, borders, clear),
        *_labels.names(named.names, counts[len(latitude) :], of, seen),
    ]
    return Ground(rgb, marks, told)
