"""Distance of the flames in each pixel of a picture, for the gaps of foliage in front of them."""

from __future__ import annotations

import numpy as np
from firetwin_core import volume
from firetwin_core.flames import FlameVolume
from numpy.typing import NDArray

from ..geometry.grids import dilate
from .rays import Rays

CELL = 2  # pixels along a cell of the result: flames are smoother than foliage
_TAPS, _NEAREST = 48, 1.0e-3  # distances along a ray; the nearest over the farthest
_FAINT = 0.02  # of white: fainter flames are not seen in gaps

Array = NDArray[np.float32]


def measure(
    flames: FlameVolume, rays: Rays, light: volume.Illumination, farthest: float, white: float
) -> Array:
    """Return the distance (h, w) within which half of the flames' light is emitted, m; 0 without flames.

    Parameters
    ----------
    rays
        One ray in each cell.
    light
        Light in air without smoke.
    farthest
        Distance up to which flames are drawn, m.
    white
        Radiance that is white in the picture.
    """
    directions = rays.directions.reshape(-1, 3)
    at = (farthest * np.geomspace(_NEAREST, 1.0, _TAPS)).astype(np.float32)
    ends = np.broadcast_to(at, (len(directions), _TAPS))
    red = volume.march([], rays.origins, directions, ends, light, 0.5, pixel=rays.pixel, flames=flames)[
        ..., 0
    ]
    half = 0.5 * red[:, -1:]
    after = np.clip((red < half).sum(axis=1), 1, _TAPS - 1)
    row = np.arange(len(red))
    low, high = red[row, after - 1], red[row, after]
    part = np.clip((half[:, 0] - low) / np.maximum(high - low, 1.0e-9), 0.0, 1.0)
    distance = at[after - 1] * (at[after] / at[after - 1]) ** part
    found = np.where(red[:, -1] > _FAINT * white, distance, 0.0)
    found = found.reshape(rays.directions.shape[:2]).astype(np.float32)
    # Rays of a pixel begin up to a pixel aside of it.
    return np.where(found > 0.0, found, dilate(found, 1))


def of_pixels(distance: Array, height: int, width: int) -> Array:
    """Repeat the cells (ch, cw) of a distance for the pixels (h, w) of a picture."""
    return distance.repeat(CELL, axis=0).repeat(CELL, axis=1)[:height, :width]
