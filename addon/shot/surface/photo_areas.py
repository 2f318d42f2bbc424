"""Areas of the ground that an orthophoto is shown in: all of it, and finer near the cameras."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...run import areas
from ..terrain.raster import Array

if TYPE_CHECKING:
    from ..shot import Shot


def areas_of(
    shot: Shot,
    bounds: tuple[float, float, float, float],
    step: float,
    factors: Sequence[float] = (1.0,),
) -> list[tuple[Array, Array]]:
    """Choose pictures by their corners (2,), (2,), m: all ground within `bounds`, and areas near cameras.

    An area that would be hardly finer than the previous one is left out.

    Parameters
    ----------
    bounds
        West, south, east and north, degrees.
    step
        Size of the finest pixels that make sense, m.
    factors
        How far areas reach from the cameras' paths, in units of `terrain.near_radius`, falling.
    """
    ground, largest = shot.ground, shot.settings.terrain.photo_size
    low, high = _whole(shot, bounds)
    areas = [(low, high)]
    coarse = float(np.max((high - low) / size_of(low, high, step, largest)))
    for radius in ground.near_radius * np.asarray(factors) if len(ground.eyes) else ():
        eyes = ground.eyes[:, :2]
        near_low = np.clip(eyes.min(axis=0) - radius, low, high)
        near_high = np.clip(eyes.max(axis=0) + radius, low, high)
        fine = max(step, float(np.max(near_high - near_low)) / largest)
        if radius > 0.0 and np.all(near_high - near_low > step) and fine < 0.7 * coarse:
            areas.append((near_low, near_high))
            coarse = fine
    return areas


def _whole(shot: Shot, bounds: tuple[float, float, float, float]) -> tuple[Array, Array]:
    """Corners (2,) of the ground within bounds, m."""
    fields = shot.ground.fields
    rows, columns = (np.array([axis[0], axis[-1]]) for axis in (fields.latitude, fields.longitude))
    west, south, east, north = bounds
    rows = np.clip([south, north], *rows)
    turned = areas.turned([west, east], columns.mean())
    if east - west < 360.0 and turned[0] < turned[1]:  # else it is all around the Earth
        columns = np.clip(turned, *columns)
    corners = shot.ground.point(*(v.ravel() for v in np.meshgrid(rows, columns)))[:, :2]
    return corners.min(axis=0), corners.max(axis=0)


def size_of(low: Array, high: Array, step: float, largest: int) -> NDArray[np.int64]:
    """Columns and rows of a picture with pixels of `step` (m), or as large as it may be."""
    return np.clip(np.ceil((high - low) / step), 2, largest).astype(int)
