"""Ground picture: the ground in one picture, in the terrain's texture coordinates, without Blender.

It has the mean colours of the ground's material, an orthophoto where the scene has one, and the burned area
at a time. The material itself is made of noise at the size of pixels, for each view.
"""

from __future__ import annotations

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...imaging import srgb
from ...shot.shot import Shot
from ...shot.surface import orthophoto
from ...shot.terrain import noise
from ..forest import biomes

LARGEST = 2048  # pixels, longest side
_BARE, _GRASS, _FOREST = (0.120, 0.110, 0.100), (0.080, 0.070, 0.045), (0.030, 0.040, 0.018)
_WATER, _CHAR, _ASH = (0.020, 0.045, 0.070), (0.020, 0.019, 0.018), (0.048, 0.046, 0.043)
_DENSE, _VARIED = 0.7, 0.25  # kg/m2 of canopy fuel that hides grass; range of the variation between cells
_STEPS = 4.0  # steps of the variation: few values make small files
_PHOTO, _SHOULDER = 0.5, 0.8  # reflectances of a photograph, as in `material`


def paint(shot: Shot, times: NDArray[np.float64], largest: int = LARGEST) -> list[NDArray[np.uint8]]:
    """Paint the ground at each of these model times (s).

    Returns
    -------
    Pictures (rows, columns, 3), sRGB; the northern row comes first.
    """
    ground = shot.ground
    rows, columns = ground.shape
    size = min(1.0, largest / max(rows, columns))
    height, width = (max(round(size * count), 1) for count in (rows, columns))
    row = (np.arange(height) + 0.5) / height * rows - 0.5
    column = (np.arange(width) + 0.5) / width * columns - 0.5
    at = np.meshgrid(np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1), indexing="ij")
    row, column = (axis.ravel() for axis in at)
    unburned, burned = _unburned(shot, row, column), _burned(shot, row, column)
    unburned = _with_photo(shot, row, column, unburned)
    arrival = ground.arrival_at(row, column)
    return [
        encode(np.where((arrival <= time)[:, None], burned, unburned)).reshape(height, width, 3)[::-1]
        for time in times
    ]


def encode(linear: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Encode linear values in 0..1 as sRGB bytes (IEC 61966-2-1)."""
    return np.round(255.0 * srgb.to_display(np.clip(linear, 0.0, 1.0))).astype(np.uint8)


def _varied(row: NDArray[np.float64], column: NDArray[np.float64], seed: int) -> NDArray[np.float64]:
    """Return factors (n, 1) near 1 that differ between cells."""
    lot = noise.uniform(np.rint(row).astype(np.int64), np.rint(column).astype(np.int64), seed)
    return 1.0 + _VARIED * (np.floor(_STEPS * lot[:, None]) / (_STEPS - 1.0) - 0.5)


def _unburned(shot: Shot, row: NDArray[np.float64], column: NDArray[np.float64]) -> NDArray[np.float64]:
    ground, here = shot.ground, biomes.choose(shot)

    def at(field: NDArray) -> NDArray[np.float64]:
        return bilinear(np.asarray(field, np.float64), row, column)[:, None]

    grass = np.array(_GRASS)
    if (land := here.biome.open_land) is not None:
        grass = np.array(land.straw) + here.green * (np.array(land.green) - land.straw)
    dense = np.clip(at(ground.fields.canopy_fuel) / _DENSE, 0.0, 1.0)
    shade = grass + (np.array(_FOREST) - grass) * dense
    shade = shade + (np.array(_BARE) - shade) * np.clip(at(ground.bare), 0.0, 1.0)
    shade = shade * _varied(row, column, shot.settings.seed + 950)
    return np.asarray(np.where(at(ground.water) > 0.5, _WATER, shade), np.float64)


def _burned(shot: Shot, row: NDArray[np.float64], column: NDArray[np.float64]) -> NDArray[np.float64]:
    part = noise.uniform(
        np.rint(row).astype(np.int64), np.rint(column).astype(np.int64), shot.settings.seed + 951
    )[:, None]
    part = np.floor(_STEPS * part) / (_STEPS - 1.0)
    return np.asarray(np.array(_CHAR) + part * (np.array(_ASH) - _CHAR), np.float64)


def _with_photo(
    shot: Shot, row: NDArray[np.float64], column: NDArray[np.float64], shade: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Lay the scene's orthophotos over the colours, finer ones over coarser ones."""
    pictures = orthophoto.pictures(shot)
    if not pictures:
        return shade
    ground = shot.ground
    place = ground.frame.forward(*ground.places(row, column), ground.height(row, column))[:, :2]
    for picture in pictures:
        height, width = picture.pixels.shape[:2]
        part = (place - picture.low) / (np.asarray(picture.high) - picture.low)
        inside = np.flatnonzero(np.all((part >= 0.0) & (part < 1.0), axis=1))
        pixel = picture.pixels[
            (part[inside, 1] * height).astype(np.int64), (part[inside, 0] * width).astype(np.int64)
        ]
        colour = _PHOTO * srgb.to_linear(pixel[:, :3].astype(np.float64) / 255.0)
        colour = colour / (1.0 + _SHOULDER * colour.mean(axis=1, keepdims=True))
        share = pixel[:, 3:] / 255.0
        shade[inside] += share * (colour - shade[inside])
    return shade
