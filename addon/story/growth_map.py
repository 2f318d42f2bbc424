"""Pictures of a fire's growth from above: burned area in colours of arrival time, on the shaded relief.

Only the burned area changes from picture to picture: relief, lines of equal arrival, names, scale and legend
are drawn once. Needs no matplotlib, which Blender does not have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property

import numpy as np
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ..blender import text
from ..blender.text import Line
from ..ellipsoid import metres_per_degree
from ..geometry.grids import dilate
from ..run import areas, front, fronts, measure, thumbnails, times
from ..run.arrival_grid import fill_unburned
from ..run.labels import Label
from .words import LETTERS, SAFE, Words

RAMP = ("#4a1d6e", "#8c2375", "#cc3b5c", "#f06a3a", "#fba318", "#f7e26b")
"""Colours of arrival times, first to last."""
_BEFORE = (0.32, 0.30, 0.29)  # burned before the run
_BARE, _GREEN, _OUTSIDE = (0.86, 0.83, 0.76), (0.55, 0.66, 0.46), (0.30, 0.31, 0.32)
_GLOW = (1.0, 0.97, 0.75)
_GLOWING = 1.0 / 60.0  # of the run, time in which the front's glow fades to a third
_TALL, _WIDE = 0.58, 0.8  # of the picture, largest height and width of the fire
_LOW = 0.07  # of the picture, the fire's centre above the picture's: captions are below
_LEAST = 4.0  # cells of the run, least half of the map's height
_STEEP = 2.0  # vertical exaggeration of the shading
_LIGHT = np.array([-0.5, 0.5, np.sqrt(0.5)])  # unit vector to the light, in the north-west: east, north, up
_LINES = 12  # most lines of equal arrival
_WHITE, _GREY = (1.0, 1.0, 1.0), (0.72, 0.74, 0.76)

Array = NDArray[np.float64]
Picture = NDArray[np.float32]


@dataclass(frozen=True)
class Growth:
    """Map of a run.

    Attributes
    ----------
    places
        Named places; a name is grey until the fire reaches its place.
    zone
        Time zone of the legend.
    size
        Width and height, pixels.
    words
        Words of the scale bar and the legend.
    """

    run: Run
    places: Sequence[Label]
    zone: str
    size: tuple[int, int]
    words: Words = Words()  # noqa: RUF009 (immutable)
    _letters: dict[tuple[bool, ...], tuple[Array, Array]] = field(default_factory=dict, repr=False)

    @cached_property
    def scale(self) -> float:
        """Metres of a pixel."""
        return self._frame[2]

    @cached_property
    def arrival(self) -> Array:
        """Arrival time (h, w) at each pixel, s; infinite where the fire does not arrive in the run."""
        reach, last = front.reach(self.run), float(self.run.times[-1])
        row, column = reach.at(*self._pixels)
        since = bilinear(fill_unburned(reach.arrival - last), np.nan_to_num(row), np.nan_to_num(column))
        return np.where(np.isfinite(row) & (since <= 0.0), last + since, np.inf)

    def draw(self, moment: datetime) -> Picture:
        """Draw the picture (h, w, 3) of a time, from 0 to 1, top row first."""
        now = times.seconds(self.run, moment)
        age = now - self.arrival
        picture = np.where((age >= 0.0)[..., None], self._burned, self._ground)
        span = max(float(self.run.times[-1] - self.run.times[0]), 1.0)
        glow = np.where(age >= 0.0, np.exp(-np.maximum(age, 0.0) / (_GLOWING * span)), 0.0)[..., None]
        picture = picture * (1.0 - glow) + np.array(_GLOW) * glow
        keep, add = self._lettered(tuple(now >= at for at, _ in self._names))
        return np.clip(picture * keep + add, 0.0, 1.0).astype(np.float32)

    def _lettered(self, reached: tuple[bool, ...]) -> tuple[Array, Array]:
        """Return factor and term (h, w, 3) of letters and legend; names of reached places are white."""
        if reached not in self._letters:
            layers = [
                (names, _WHITE if burns else _GREY)
                for burns, (_, names) in zip(reached, self._names, strict=True)
            ]
            keep, add = self._legend
            for opacity, colour in (*layers, (self._marks, _WHITE)):
                keep, add = (
                    _written(each, opacity, tint) for each, tint in ((keep, (0.0,) * 3), (add, colour))
                )
            self._letters[reached] = keep, add
        return self._letters[reached]

    @cached_property
    def _frame(self) -> tuple[float, float, float]:
        """Latitude and longitude of the centre (degrees), and metres of a pixel."""
        run = self.run
        reach, last = front.reach(run), float(run.times[-1])
        with np.errstate(invalid="ignore"):
            burned = reach.arrival <= last
        latitude, longitude, (wide, tall) = areas.bounds(reach.latitude, reach.longitude, burned)
        cell = max(areas.cell_size(run.fuel_latitude, run.fuel_longitude))
        width, height = self.size
        scale = max(tall / (_TALL * height), wide / (_WIDE * width), 2.0 * _LEAST * cell / height)
        return latitude - _LOW * height * scale / metres_per_degree(latitude)[0], longitude, scale

    @cached_property
    def _pixels(self) -> tuple[Array, Array]:
        """Latitude and longitude (h, w) of the pixels' centres, degrees."""
        width, height = self.size
        latitude, longitude, scale = self._frame
        north, east = metres_per_degree(latitude)
        up = (0.5 * height - 0.5 - np.arange(height)) * scale / north
        right = (np.arange(width) + 0.5 - 0.5 * width) * scale / east
        return tuple(np.meshgrid(latitude + up, longitude + right, indexing="ij"))  # type: ignore[return-value]

    def _sampled(self, field: NDArray, latitude: Array, longitude: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Sample a field (ny, nx) of a grid at the pixels; also whether they lie on the grid."""
        steps = []
        for at, axis in zip(self._pixels, (latitude, longitude), strict=True):
            order = np.argsort(axis)
            steps.append((np.interp(at, axis[order], order.astype(np.float64)), areas.edges(axis)))
        inside = np.ones(self.size[::-1], np.bool_)
        for at, (_, edges) in zip(self._pixels, steps, strict=True):
            inside &= (at >= edges.min()) & (at <= edges.max())
        values = np.nan_to_num(np.asarray(field, np.float64))
        if min(values.shape) < 2:
            return np.full(inside.shape, float(values.mean())), inside
        return bilinear(values, steps[0][0], steps[1][0]), inside

    @cached_property
    def _ground(self) -> Array:
        """Unburned ground (h, w, 3), greener with more fuel, with lines of equal arrival."""
        run = self.run
        fuel = np.nan_to_num(run.surface_fuel) + np.nan_to_num(run.canopy_fuel)
        load, inside = self._sampled(fuel, run.fuel_latitude, run.fuel_longitude)
        share = np.clip(load / max(float(np.percentile(fuel, 95)), 1e-6), 0.0, 1.0)[..., None]
        colour = np.array(_BARE) * (1.0 - share) + np.array(_GREEN) * share
        return np.where(inside[..., None], colour * self._shade[..., None], np.array(_OUTSIDE))

    @cached_property
    def _shade(self) -> Array:
        """Shading of the relief (h, w), 0.45 to 1.1; 0.9 on level ground."""
        height, _ = self._sampled(self.run.elevation, self.run.latitude, self.run.longitude)
        if min(height.shape) < 2:
            return np.full(height.shape, 0.9)
        down, right = np.gradient(height * _STEEP, self.scale)
        normal = np.stack([-right, down, np.ones_like(height)], axis=-1)
        lit = normal @ _LIGHT / np.linalg.norm(normal, axis=-1)
        return np.clip(0.9 + 0.9 * (lit - _LIGHT[2]), 0.45, 1.1)

    @cached_property
    def _burned(self) -> Array:
        """Burned ground (h, w, 3) in the colours of its arrival time, with lines of equal arrival."""
        first, last = float(self.run.times[0]), float(self.run.times[-1])
        arrival = np.minimum(self.arrival, last)
        share = np.clip((arrival - first) / max(last - first, 1.0), 0.0, 1.0)
        colour = thumbnails.coloured(share, RAMP).astype(np.float64)
        colour[self.arrival < first] = _BEFORE
        shaded = colour * (0.35 + 0.65 * self._shade[..., None])
        return np.where(self._isochrones[..., None], 0.55 * shaded, shaded)

    @cached_property
    def _isochrones(self) -> NDArray[np.bool_]:
        """Pixels (h, w) on lines of equal arrival at round local times."""
        moments = fronts.choose_times(self.run, self.zone)[1:-1]
        moments = moments[:: -(-len(moments) // _LINES) or 1]
        line = np.zeros(self.arrival.shape, np.bool_)
        for moment in moments:
            burned = self.arrival <= moment
            line[:-1] |= burned[:-1] != burned[1:]
            line[:, :-1] |= burned[:, :-1] != burned[:, 1:]
        return line

    def _at(self, latitude: float, longitude: float) -> tuple[float, float]:
        """Place of a point from the lower left corner, pixels."""
        middle_latitude, middle_longitude, scale = self._frame
        north, east = metres_per_degree(middle_latitude)
        width, height = self.size
        longitude = float(areas.turned(longitude, middle_longitude))
        return (
            0.5 * width + (longitude - middle_longitude) * east / scale,
            0.5 * height + (latitude - middle_latitude) * north / scale,
        )

    @cached_property
    def _names(self) -> list[tuple[float, Picture]]:
        """Arrival time at each named place in the picture, s, and its name as opacity (h, w)."""
        width, height = self.size
        size, drawn = LETTERS * height, []
        for place in self.places:
            x, y = self._at(place.latitude, place.longitude)
            room = text.measure_width(place.name, size) + size
            if not (SAFE * width < x < (1.0 - SAFE) * width - room and 0.22 * height < y < 0.9 * height):
                continue
            names = text.draw_lines([Line(place.name, size, x + 0.5 * size, y - 0.35 * size)], width, height)
            row, column, half = int(height - y), int(x), max(int(0.16 * size), 1)
            names[row - half : row + half + 1, column - half : column + half + 1] = 1.0
            drawn.append((float(self.arrival[row, column]), names))
        return drawn

    @cached_property
    def _marks(self) -> Picture:
        """Scale bar, north arrow and times of the legend as opacity (h, w)."""
        width, height = self.size
        size = LETTERS * height
        right, top = (1.0 - SAFE) * width, height - self._bar[1]
        length = measure.round_length(0.22 * width * self.scale)
        bar = length / self.scale
        label = self.words.length(length)
        left, _, end, _ = self._bar
        first, last = (self._clock(float(self.run.times[k])) for k in (0, -1))
        lines = [
            Line(label, size, right - 0.5 * bar - 0.5 * text.measure_width(label, size), top + 0.5 * size),
            Line(f"{self.words.north} ↑", size, right - bar - 2.5 * size, top - 0.3 * size),
            Line(first, size, left, top + 0.5 * size),
            Line(last, size, end - text.measure_width(last, size), top + 0.5 * size),
        ]
        opacity = text.draw_lines(lines, width, height)
        row, thick = int(height - top), max(int(0.12 * size), 1)
        opacity[row : row + thick, int(right - bar) : int(right)] = 1.0
        return opacity

    @property
    def _bar(self) -> tuple[int, int, int, int]:
        """Left, top, right and lower edge of the legend, pixels from the upper left corner."""
        width, height = self.size
        size = LETTERS * height
        left, top = SAFE * width, SAFE * height + 1.5 * size
        return int(left), int(top), int(left + 0.34 * width), int(top + 0.6 * size)

    @cached_property
    def _legend(self) -> tuple[Array, Array]:
        """Factor and term (h, w, 3) of the colours of arrival times."""
        shape = (*self.size[::-1], 3)
        keep, add = np.ones(shape), np.zeros(shape)
        left, top, right, low = self._bar
        keep[top:low, left:right] = 0.0
        add[top:low, left:right] = thumbnails.coloured(np.linspace(0.0, 1.0, right - left), RAMP)
        return keep, add

    def _clock(self, time: float) -> str:
        """Format day and time of a model time (s): ``17 Sep 19:00``."""
        day, month, _, clock, *_ = times.text(times.utc(self.run, time), self.zone).split(" ")
        return self.words.date(f"{day} {month} {clock}")


def _written(picture: Array, opacity: Picture, colour: tuple[float, float, float]) -> Array:
    """Write letters in a colour over a picture, with a dark outline of a pixel."""
    picture = picture * (1.0 - 0.75 * dilate(opacity, 1)[..., None])
    return picture * (1.0 - opacity[..., None]) + np.array(colour) * opacity[..., None]
