"""Control line around the fire: the front without the detail that no crew follows.

Bays and gaps of the burned area up to twice a radius are closed, and the line runs at a distance from the
fire's edge (an indirect line; NWCG glossary). This is a morphological closing of the burned cells: the ground
within radius and distance of burned cells, without the ground within the radius of its edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..run.arrival_grid import ArrivalGrid, pad_axis
from ..run.front import Reach, contour
from . import INDIRECT, RADIUS

Array = NDArray[np.float64]
Line = tuple[Array, Array, NDArray[np.int64]]
"""Latitude and longitude (n,) of points, degrees, and the index of the next point."""


@dataclass(frozen=True)
class LineOptions:
    """Options of a control line: radius of closed bays, and distance from the fire's edge, m."""

    radius: float = RADIUS
    indirect: float = INDIRECT

    def describe(self) -> str:
        """Describe the line in metres."""
        if self.radius == self.indirect == 0.0:
            return "the line follows the front in all detail"
        return (
            f"the line closes bays and gaps up to {2.0 * self.radius:,.0f} m wide and runs "
            f"{self.indirect:,.0f} m outside the fire's edge (indirect line)"
        )


USUAL = LineOptions()


def trace(grid: ArrivalGrid, reach: Reach, time: float, options: LineOptions = USUAL) -> Line:
    """Trace the control line at a model time (s); burned ground is on its left."""
    burned = grid.arrival <= time
    if options.radius == options.indirect == 0.0 or not burned.any():
        return reach.line(time)
    width, height = grid.cell
    radius, margin = options.radius, options.radius + options.indirect
    pad = 2 + int(np.ceil((margin + radius) / min(width, height)))
    box = tuple(
        slice(int(found[0]), int(found[-1]) + 1)
        for found in (np.flatnonzero(burned.any(axis)) for axis in (1, 0))
    )
    mask = np.pad(burned[box], pad)
    if radius > 0.0:
        near = distance(mask, (width, height), margin) <= margin
        field = radius - distance(~near, (width, height), radius + width + height)
    else:
        field = distance(mask, (width, height), margin + width + height) - margin
    y, x, after = contour(field)
    latitude, longitude = (
        np.interp(at, np.arange(part.stop - part.start + 2 * pad), _extend(axis[part], pad))
        for at, axis, part in ((y, grid.latitude, box[0]), (x, grid.longitude, box[1]))
    )
    return latitude, longitude, after


def distance(mask: NDArray[np.bool_], cell: tuple[float, float], most: float) -> Array:
    """Compute the distance (ny, nx), m, from cell centres to the nearest True cell, exact up to `most`.

    Distances along rows, then the least over the rows around, as squares add (Felzenszwalb and
    Huttenlocher 2012, Theory of Computing 8, 415-428).
    """
    width, height = cell
    ny, nx = mask.shape
    column = np.arange(nx, dtype=np.float64)
    left = np.maximum.accumulate(np.where(mask, column, -np.inf), axis=1)
    right = np.minimum.accumulate(np.where(mask, column, np.inf)[:, ::-1], axis=1)[:, ::-1]
    along = (width * np.minimum(column - left, right - column)) ** 2
    reach = min(ny - 1, int(most / height) + 1)
    padded = np.pad(along, ((reach, reach), (0, 0)), constant_values=np.inf)
    least = along.copy()
    for step in range(-reach, reach + 1):
        np.minimum(least, padded[reach + step : reach + step + ny] + (step * height) ** 2, out=least)
    return np.sqrt(least)


def _extend(axis: Array, count: int) -> Array:
    """Extend cell centres by a number of cells at each end."""
    for _ in range(count):
        axis = pad_axis(axis)
    return axis
