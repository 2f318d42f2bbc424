"""Interface of the sources of an orthophoto: colours at places; and functions to sample pictures."""

from __future__ import annotations

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...errors import InputError
from ..terrain.raster import Array

Pixels = NDArray[np.uint8]


class PhotoSource:
    """An orthophoto: `bounds` (west, south, east, north), degrees, and `resolution`, m."""

    bounds: tuple[float, float, float, float]
    resolution: float

    def error(self, reason: str) -> InputError:
        """Error about the file."""
        raise NotImplementedError

    def colours(self, latitude: Array, longitude: Array, step: float) -> NDArray[np.float32]:
        """Colours 0..1 and coverage (h, w, 4) at points (h, w) about `step` metres apart."""
        raise NotImplementedError


def thinned(pixels: Pixels, size: int) -> NDArray[np.float32]:
    """Means 0..1 of blocks of size x size pixels."""
    height, width, bands = pixels.shape
    pixels = np.pad(pixels, [(0, -height % size), (0, -width % size), (0, 0)], "edge")
    shape = pixels.shape[0] // size, size, pixels.shape[1] // size, size, bands
    return pixels.reshape(shape).mean(axis=(1, 3), dtype=np.float32) / np.float32(255.0)


def between_pixels(field: NDArray[np.float32], row: Array, column: Array) -> NDArray[np.float32]:
    """Bilinear values (h, w, bands) between pixels; NaN beyond the edges of the outermost pixels."""
    height, width, _ = field.shape
    outside = (row < -0.5) | (row > height - 0.5) | (column < -0.5) | (column > width - 0.5)
    found = bilinear(field, np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)).astype(np.float32)
    found[outside] = np.nan
    return found


def rgba(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """Convert grey, grey-alpha, RGB or RGBA (h, w, bands), NaN for no data, to RGBA (h, w, 4)."""
    bands = pixels.shape[-1]
    grey = bands < 3
    alpha = pixels[..., -1] if bands in (2, 4) else np.ones(pixels.shape[:2], np.float32)
    colour = np.repeat(pixels[..., :1], 3, axis=-1) if grey else pixels[..., :3]
    alpha = np.where(np.isfinite(pixels).all(axis=-1), alpha, 0.0)
    return np.concatenate([colour, alpha[..., None]], axis=-1).astype(np.float32)
