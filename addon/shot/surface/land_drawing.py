"""Drawing of mapped features: crop rows, stubble and margins of fields, wheel ruts, shoulders and banks.

Pictures are arrays of 8 bits (red, green, blue in sRGB, and opacity). Sizes (m) and colours are by eye.
Patterns finer than two pixels are left out.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..terrain import rasterize

Array = NDArray[np.float64]
Colour = tuple[float, float, float]

CROP, PLOUGHED, STUBBLE, MOWN = "crop", "ploughed", "stubble", "mown"

_ROWS = {CROP: (2.2, 0.16), PLOUGHED: (2.6, 0.20), STUBBLE: (7.5, 0.10), MOWN: (5.0, 0.05)}
"""Distance between the rows of each kind of field, m, and their contrast."""

_TRAMLINES, _GAUGE, _TYRE = 24.0, 0.9, 0.5  # m: distance of a sprayer's tracks; half its gauge; a tyre
_HEADLAND, _MARGIN = 9.0, 1.6  # m from the boundary: where machines turn, and a strip of grass
_GRASS: Colour = (0.36, 0.35, 0.21)  # margins, and the middle of a track
_SOIL: Colour = (0.40, 0.33, 0.25)
_GRAVEL, _SHOULDER = (0.47, 0.44, 0.39), 1.1  # colour, and width of a shoulder on each side, m
_REEDS, _MUD = (0.21, 0.23, 0.12), (0.41, 0.36, 0.28)
_BANK, _SHORE = 5.0, 1.4  # m from the water: wet plants, and bare mud
_RUTS = 4.5  # m, width from which a track has no grass in its middle
_FINE = 0.8  # m, largest pixel that shows ruts


class LandPicture:
    """A picture that is being drawn.

    Attributes
    ----------
    pixels
        (rows, columns, 4) uint8, rows from south to north.
    low, pixel
        (2,) south-western corner in the scene, and size of a pixel, m.
    """

    def __init__(self, low: Array, high: Array, size: NDArray[np.int64]) -> None:
        self.low, self.pixel = low, (high - low) / size
        self.pixels = np.zeros((size[1], size[0], 4), np.uint8)

    @property
    def metre(self) -> float:
        """Pixels in a metre."""
        return 1.0 / float(np.mean(self.pixel))

    def filled(self, rings: Sequence[Array]) -> rasterize.Covered | None:
        """Coverage of a polygon of rings (n, 2), m."""
        return rasterize.filled([self._at(ring) for ring in rings], self._shape)

    def stroked(self, line: Array, width: float) -> rasterize.Covered | None:
        """Coverage of a line (n, 2) of a width, m."""
        return rasterize.stroked(self._at(line), width * self.metre, self._shape)

    def blend(self, found: rasterize.Covered | None, colour: Array | Colour, strength: float = 1.0) -> None:
        """Draw a colour, of one value or of one per pixel, over the picture; it sets the opacity too."""
        if found is None:
            return
        window, cover = found
        part = self.pixels[window]
        cover = np.clip(cover, 0.0, 1.0)
        above, below = strength * cover, part[..., 3] / 255.0 * (1.0 - cover)
        total = above + below
        weight = np.where(total > 0.0, above / np.where(total > 0.0, total, 1.0), 0.0)[..., None]
        mixed = part[..., :3] / 255.0 * (1.0 - weight) + np.clip(colour, 0.0, 1.0) * weight
        part[..., :3], part[..., 3] = np.rint(255.0 * mixed), np.rint(255.0 * total)

    def fill(self, found: rasterize.Covered, channels: Sequence[Array], strength: float) -> None:
        """Set the colour (red, green, blue: each (h, w)) and opacity of pixels that are covered."""
        window, cover = found
        part, mask = self.pixels[window], cover > 0.0
        for channel, values in enumerate(channels):
            np.copyto(part[..., channel], np.uint8(255.0 * np.clip(values, 0.0, 1.0) + 0.5), where=mask)
        part[..., 3][mask] = round(255.0 * strength)

    @property
    def _shape(self) -> tuple[int, int]:
        return self.pixels.shape[0], self.pixels.shape[1]

    def _at(self, line: Array) -> Array:
        return (line - self.low) / self.pixel


def draw_area(picture: LandPicture, rings: Sequence[Array], colour: Colour, strength: float) -> None:
    """Draw a polygon in one colour."""
    if (found := picture.filled(rings)) is not None:
        picture.fill(found, [np.asarray(part) for part in colour], strength)


def draw_field(
    picture: LandPicture, rings: Sequence[Array], colour: Colour, strength: float, pattern: str
) -> None:
    """Draw a field: rows along its longest side, tramlines in crops, headlands, and a strip of grass."""
    covered = picture.filled(rings)
    if covered is None:
        return
    across = _across(picture, covered[0], rings[0])
    distance, contrast = _ROWS[pattern]
    seen = float(np.clip(0.5 * distance * picture.metre - 1.0, 0.0, 1.0))
    tone = 1.0 + np.float32(contrast * seen) * np.sin(np.float32(2.0 * np.pi / distance) * across)
    if pattern == STUBBLE:  # swaths of a combine alternate, each with a row of straw
        tone += np.float32(0.06 * seen) * np.sign(np.sin(np.float32(np.pi / distance) * across))
    wheels = _tramlines(across, picture) if pattern == CROP else np.float32(0.0)
    shade = [part * tone + wheels * (soil - part * tone) for part, soil in zip(colour, _SOIL, strict=True)]
    picture.fill(covered, shade, strength)
    sides = [np.stack(side) for ring in rings for side in zip(ring, np.roll(ring, -1, axis=0), strict=True)]
    red, green, blue = (0.94 * part for part in colour)
    for width, over, part in ((_HEADLAND, (red, green, blue), strength), (_MARGIN, _GRASS, 0.8 * strength)):
        for side in sides:
            near = picture.stroked(side, 2.0 * width)
            if near is not None:
                picture.blend((near[0], near[1] * _within(covered, near[0], near[1].shape)), over, part)


def draw_track(picture: LandPicture, line: Array, width: float, colour: Colour) -> None:
    """Draw a track: two ruts and grass between, if it is narrow and pixels are fine enough."""
    if width > _RUTS or width < 3.0 * _TYRE or float(np.mean(picture.pixel)) > _FINE:
        picture.blend(picture.stroked(line, width), colour)
        return
    picture.blend(picture.stroked(line, width), _GRASS, 0.65)
    for side in (-1.0, 1.0):
        rut = _beside(line, side * min(_GAUGE, 0.5 * width - 0.5 * _TYRE))
        picture.blend(picture.stroked(rut, 1.4 * _TYRE), colour)


def draw_road(picture: LandPicture, line: Array, width: float, colour: Colour) -> None:
    """Draw a sealed road with shoulders of gravel."""
    picture.blend(picture.stroked(line, width + 2.0 * _SHOULDER), _GRAVEL, 0.85)
    picture.blend(picture.stroked(line, width), colour)


def draw_bank(picture: LandPicture, line: Array, width: float) -> None:
    """Draw the bank of a water course `width` m wide, or along a shore: wet plants and bare mud."""
    picture.blend(picture.stroked(line, width + 2.0 * _BANK), _REEDS, 0.6)
    picture.blend(picture.stroked(line, width + 2.0 * _SHORE), _MUD, 0.75)


def _within(
    covered: rasterize.Covered | None, window: tuple[slice, slice], shape: tuple[int, ...]
) -> NDArray[np.float64]:
    """Coverage of another window, on the pixels of this one."""
    inner = np.zeros(shape)
    if covered is None:
        return inner
    theirs, cover = covered
    to, of = [], []
    for mine, other in zip(window, theirs, strict=True):
        first, last = max(mine.start, other.start), min(mine.stop, other.stop)
        if last <= first:
            return inner
        to.append(slice(first - mine.start, last - mine.start))
        of.append(slice(first - other.start, last - other.start))
    inner[tuple(to)] = cover[tuple(of)]
    return inner


def _across(picture: LandPicture, window: tuple[slice, slice], ring: Array) -> NDArray[np.float32]:
    """Distance (m) of a window's pixels across the rows, which run along the longest side of the ring."""
    sides = np.roll(ring, -1, axis=0) - ring
    side = sides[np.argmax(np.hypot(*sides.T))]
    side = side / max(float(np.hypot(*side)), 1.0e-9)
    low, (rows, columns) = picture.low - ring[0], window
    north = low[1] + (np.arange(rows.start, rows.stop) + 0.5) * picture.pixel[1]
    east = low[0] + (np.arange(columns.start, columns.stop) + 0.5) * picture.pixel[0]
    return (north * side[0]).astype(np.float32)[:, None] - (east * side[1]).astype(np.float32)


def _tramlines(across: NDArray[np.float32], picture: LandPicture) -> NDArray[np.float32]:
    """Coverage of a sprayer's wheel tracks."""
    wide = np.float32(max(0.5 * _TYRE, float(0.5 / picture.metre)))
    off = np.abs(np.abs(np.mod(across + 0.5 * _TRAMLINES, _TRAMLINES) - 0.5 * _TRAMLINES) - _GAUGE)
    return np.clip(1.5 - off / wide, 0.0, 1.0) * np.float32(min(float(0.5 * _TYRE / wide), 1.0))


def _beside(line: Array, off: float) -> Array:
    """Line (n, 2) parallel to a line, `off` m to its left."""
    along = np.gradient(line, axis=0)
    along /= np.maximum(np.hypot(*along.T), 1.0e-9)[:, None]
    return line + off * np.column_stack([-along[:, 1], along[:, 0]])
