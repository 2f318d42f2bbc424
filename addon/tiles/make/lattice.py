"""Heights on a lattice that all levels of a quadtree share, and the errors of the levels.

A level is the lattice thinned by a power of two, so that neighbours of one level share their vertices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from numpy.typing import NDArray

from ... import ellipsoid

Array = NDArray[np.float64]
CELLS = 64
"""Maximum cells along the side of a tile, if the depth is not given."""


@dataclass(frozen=True)
class Surface:
    """Heights of the ground of a tileset.

    Attributes
    ----------
    latitude, longitude
        (ny,), (nx,) degrees, ascending.
    height
        (ny, nx) m above the WGS84 ellipsoid; all finite.
    """

    latitude: Array
    longitude: Array
    height: NDArray[np.float32]


class Lattice:
    """Heights of a surface with equal numbers of cells in all tiles of a level.

    Heights of the northern and eastern edge are continued outwards, for fewer than 2**levels cells.

    Attributes
    ----------
    levels
        Depth of the quadtree: level 0 has one tile, level `levels` all points of the surface.
    cells
        Cells of a tile, south to north and west to east.
    latitude, longitude
        (rows + 1,), (columns + 1,) degrees.
    height
        (rows + 1, columns + 1) m above the ellipsoid.
    """

    def __init__(self, surface: Surface, levels: int | None = None) -> None:
        sides = [max(count - 1, 1) for count in surface.height.shape]
        if levels is None:
            levels = max(int(np.ceil(np.log2(max(sides) / CELLS))), 0)
        self.levels = levels
        self.cells = (-(-sides[0] >> levels), -(-sides[1] >> levels))
        more = [
            (cells << levels) + 1 - count
            for cells, count in zip(self.cells, surface.height.shape, strict=True)
        ]
        self.latitude, self.longitude = (
            _continued(axis, count)
            for axis, count in zip((surface.latitude, surface.longitude), more, strict=True)
        )
        self.height = np.pad(surface.height, [(0, count) for count in more], "edge")

    def stride(self, level: int) -> int:
        """Return the lattice steps between vertices of a level."""
        return 1 << (self.levels - level)

    def block(self, level: int, row: int, column: int) -> tuple[slice, slice]:
        """Return rows and columns of the lattice under a tile, borders included."""
        height, width = (cells * self.stride(level) for cells in self.cells)
        return slice(row * height, (row + 1) * height + 1), slice(column * width, (column + 1) * width + 1)

    def error(self, level: int, row: int, column: int) -> float:
        """Compute the largest vertical distance, m, of a tile's triangles from the lattice under it.

        The sag of a chord of length d below the ellipsoid, d^2 / 8R, is added.
        """
        stride = self.stride(level)
        height = self.height[self.block(level, row, column)]
        off = 0.0 if stride == 1 else float(np.abs(triangulated(height, stride) - height).max())
        return off + self._sag(stride)

    def edge_gap(self, level: int, row: int, column: int) -> float:
        """Compute the largest distance, m, of a tile's four edges from the same lines at other levels."""
        rows, columns = self.block(level, row, column)
        lines = (
            self.height[rows.start, columns],
            self.height[rows.stop - 1, columns],
            self.height[rows, columns.start],
            self.height[rows, columns.stop - 1],
        )
        gap = 0.0
        for line in lines:
            own = _polyline(line, self.stride(level))
            for other in range(self.levels + 1):
                stride = min(self.stride(other), len(line) - 1)
                gap = max(gap, float(np.abs(_polyline(line, stride) - own).max()))
        return gap

    def _sag(self, stride: int) -> float:
        scale = ellipsoid.metres_per_degree(float(self.latitude.mean()))
        steps = [np.max(axis[stride:] - axis[:-stride]) for axis in (self.latitude, self.longitude)]
        diagonal = np.hypot(*(step * metres for step, metres in zip(steps, scale, strict=True)))
        radius = constants.SEMI_MAJOR_AXIS * (1.0 - constants.ECCENTRICITY_SQUARED)
        return float(diagonal**2 / (8.0 * radius))


def triangulated(height: NDArray[np.float32], stride: int) -> NDArray[np.float32]:
    """Interpolate heights (n, m) in the triangles between every `stride`-th of these heights (n, m).

    The diagonal of a cell goes from its north-western to its south-eastern corner (rows go north).
    """
    row, column = np.ix_(*(np.arange(count) / stride for count in height.shape))
    height = height[::stride, ::stride]
    y, x = (
        np.minimum(at.astype(np.int64), count - 2)
        for at, count in zip((row, column), height.shape, strict=True)
    )
    v, u = row - y, column - x
    low, east = height[y, x].astype(np.float64), height[y, x + 1]
    north, far = height[y + 1, x], height[y + 1, x + 1].astype(np.float64)
    lower = low + u * (east - low) + v * (north - low)
    upper = far + (1.0 - u) * (north - far) + (1.0 - v) * (east - far)
    return np.where(u + v <= 1.0, lower, upper).astype(np.float32)


def _polyline(line: NDArray[np.float32], stride: int) -> Array:
    at = np.arange(len(line))
    return np.interp(at, at[::stride], line[::stride].astype(np.float64))


def _continued(axis: Array, count: int) -> Array:
    """Extend an axis by `count` points with its last step."""
    step = axis[-1] - axis[-2]
    return np.concatenate([axis, axis[-1] + step * np.arange(1, count + 1)])
