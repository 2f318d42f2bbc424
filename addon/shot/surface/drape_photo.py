"""Colours of a prepared drape: pictures in Web Mercator, sampled at places."""

from __future__ import annotations

from functools import cache

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ...errors import InputError, input_error
from ...run import areas
from ...tiles.imagery import mercator
from ..terrain.raster import Array
from .drape import Drape, DrapeArea
from .photo_source import PhotoSource, Pixels, between_pixels, rgba, thinned

_MARGIN = 2  # pixels around the sampled area


class DrapePhoto(PhotoSource):
    """The pictures of a server's tiles; of several that cover a place the last."""

    def __init__(self, drape: Drape) -> None:
        self.drape = drape
        self.resolution = min(area.step for area in drape.areas)
        self._pixels = cache(self._read)
        self.bounds = self._bounds(drape.areas[0])

    def error(self, reason: str) -> InputError:
        """Error about the drape."""
        return input_error(self.drape.folder, reason)

    def colours(self, latitude: Array, longitude: Array, step: float) -> NDArray[np.float32]:
        """Colours of the finest picture that covers all points, else of the coarsest."""
        area = next(
            (each for each in self.drape.areas[:0:-1] if self._covers(each, latitude, longitude)),
            self.drape.areas[0],
        )
        row, column = self._place(area, latitude, longitude)
        return _sampled(self._pixels(area), row, column, max(int(step / area.step), 1))

    def _place(self, area: DrapeArea, latitude: Array, longitude: Array) -> tuple[Array, Array]:
        """Row and column of places in an area's picture, in pixels from its outermost centres."""
        middle = mercator.place_of(area.column + 0.5, 0.0, area.level)[1]
        column, row = mercator.tile_at(latitude, areas.turned(longitude, float(middle)), area.level)
        return (row - area.row) * area.side - 0.5, (column - area.column) * area.side - 0.5

    def _covers(self, area: DrapeArea, latitude: Array, longitude: Array) -> bool:
        row, column = self._place(area, latitude, longitude)
        height, width = self._pixels(area).shape[:2]
        inside = row.min() > -0.5, row.max() < height - 0.5, column.min() > -0.5, column.max() < width - 0.5
        return all(inside)

    def _bounds(self, area: DrapeArea) -> tuple[float, float, float, float]:
        height, width = (count / area.side for count in self._pixels(area).shape[:2])
        north, west = mercator.place_of(area.column, area.row, area.level)
        south, east = mercator.place_of(area.column + width, area.row + height, area.level)
        return float(west), float(south), float(east), float(north)

    def _read(self, area: DrapeArea) -> Pixels:
        path = self.drape.folder / area.file
        try:
            pixels = sensor.read_image(path)
        except InputError as error:
            raise input_error(path, f"{error.reason}; build the scene again") from None
        return np.rint(255.0 * np.clip(pixels, 0.0, 1.0)).astype(np.uint8)


def _sampled(pixels: Pixels, row: Array, column: Array, size: int) -> NDArray[np.float32]:
    """Colours (h, w, 4) of the means of size x size pixels; only the window that is needed is read."""
    height, width = pixels.shape[:2]
    first_row, last_row = _window(row, height, size)
    first_column, last_column = _window(column, width, size)
    field = thinned(pixels[first_row:last_row, first_column:last_column], size)
    at = ((row - first_row + 0.5) / size - 0.5, (column - first_column + 0.5) / size - 0.5)
    outside = (row < -0.5) | (row > height - 0.5) | (column < -0.5) | (column > width - 0.5)
    found = between_pixels(field, *(np.clip(v, 0.0, n - 1.0) for v, n in zip(at, field.shape, strict=False)))
    found[outside] = np.nan
    return rgba(found)


def _window(place: Array, count: int, size: int) -> tuple[int, int]:
    """First and last + 1 of the pixels that these places need, in whole blocks."""
    low = int(np.clip(np.floor(place.min()) - _MARGIN * size, 0, count - 1))
    high = int(np.clip(np.ceil(place.max()) + _MARGIN * size + 1, 1, count))
    return low // size * size, max(high, low + 1)
