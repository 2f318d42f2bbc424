"""Bounding boxes of maps in Web Mercator.

Columns of a picture are equally spaced in longitude, rows in y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ..ellipsoid import metres_per_degree
from ..errors import input_error
from ..geometry.mercator import forward, inverse
from ..run import areas

LIMIT = 85.05  # degrees; Web Mercator ends at 85.0511

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Box:
    """Bounds in degrees. Longitudes may exceed 180 degrees for a run across the antimeridian."""

    south: float
    west: float
    north: float
    east: float

    @classmethod
    def of_grid(cls, run: Run, latitude: Array, longitude: Array) -> Box:
        """Compute the outline of a run's grid from the outer edges of its cells.

        Raises
        ------
        InputError
            The grid exceeds the latitude limit of Web Mercator.
        """
        width, height = areas.cell_size(latitude, longitude)
        north, east = metres_per_degree(float(np.mean(latitude)))
        sides = []
        for axis, cell in ((latitude, height / north), (longitude, width / east)):
            edges = areas.edges(axis)[[0, -1]] if axis.size > 1 else axis[0] + cell * np.array([-0.5, 0.5])
            sides.append((float(edges.min()), float(edges.max())))
        (low, high), (left, right) = sides
        if max(-low, high) > LIMIT:
            reason = (
                f"extends beyond {LIMIT:g} degrees of latitude, the limit of the map in the briefing page"
            )
            raise input_error(run.path, reason)
        return cls(low, left, high, right)

    def joined(self, other: Box) -> Box:
        """Return the smallest box that contains both."""
        return Box(
            min(self.south, other.south),
            min(self.west, other.west),
            max(self.north, other.north),
            max(self.east, other.east),
        )

    @property
    def metres(self) -> tuple[float, float]:
        """Width and height in Web Mercator, m."""
        (west, east), (south, north) = forward([self.south, self.north], [self.west, self.east])
        return float(east - west), float(north - south)

    def rows(self, count: int) -> Array:
        """Compute the latitudes (count,) of the centres of a picture's rows, north first."""
        _, (south, north) = forward([self.south, self.north], [0.0, 0.0])
        return inverse(0.0, north - (np.arange(count) + 0.5) * (north - south) / count)[0]

    def columns(self, count: int) -> Array:
        """Compute the longitudes (count,) of the centres of a picture's columns, west first."""
        return self.west + (np.arange(count) + 0.5) * (self.east - self.west) / count

    def share(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Compute the position in a picture of the box: 0 to 1 from west to east, and from north to south."""
        x, y = forward(latitude, longitude)
        (west, _), (_, north) = forward([self.south, self.north], [self.west, self.east])
        wide, high = self.metres
        return (x - west) / wide, (north - y) / high

    def size(self, longest: int) -> tuple[int, int]:
        """Compute columns and rows of a picture with square pixels and this longer side."""
        wide, high = self.metres
        scale = longest / max(wide, high)
        return max(round(wide * scale), 1), max(round(high * scale), 1)


def cells(axis: Array, places: Array) -> NDArray[np.int64]:
    """Find the grid cell along one axis (n,) that contains each place, or the nearest cell outside.

    The axis can ascend or descend.
    """
    rising = np.argsort(axis)
    middles = areas.edges(axis[rising])[1:-1] if axis.size > 1 else np.empty(0)
    return rising[np.searchsorted(middles, places)]
