"""Distance of the flames in each pixel of a picture, for the gaps of foliage in front of them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from firetwin_core import volume
from firetwin_core.flames import FlameVolume
from numpy.typing import NDArray

from ..geometry.grids import dilate
from .rays import Rays

CELL = 2  # pixels along a cell of the result: flames are smoother than foliage
_FAINT = 0.02  # of white: fainter flames are not seen in gaps

Array = NDArray[np.float32]


class FlameCells(NamedTuple):
    """Flames in the cells (h, w) of a picture.

    Attributes
    ----------
    distance
        Distance within which half of the flames' light is emitted, m; 0 without visible flames.
    lit
        Cells whose ray, or a ray next to it, meets flames, however faint.
    """

    distance: Array
    lit: NDArray[np.bool_]


def measure(flames: FlameVolume, rays: Rays, farthest: float, white: float) -> FlameCells:
    """Measure the flames in the cells of a picture.

    Parameters
    ----------
    rays
        One ray in each cell.
    farthest
        Distance up to which flames are drawn, m.
    white
        Radiance that is white in the picture.
    """
    flat = rays.directions.reshape(-1, 3)
    measured = volume.flame_distance(flames, rays.origins, flat, farthest)
    distance, red = np.moveaxis(measured.reshape(*rays.directions.shape[:2], 2), -1, 0)
    seen = np.where(red > _FAINT * white, distance, 0.0).astype(np.float32)
    # Rays of a pixel begin up to a pixel aside of it.
    return FlameCells(np.where(seen > 0.0, seen, dilate(seen, 1)), dilate(red > 0.0, 1))


def of_pixels(cells: NDArray[Any], height: int, width: int) -> NDArray[Any]:
    """Repeat values of cells (ch, cw) for the pixels (h, w) of a picture."""
    return cells.repeat(CELL, axis=0).repeat(CELL, axis=1)[:height, :width]
