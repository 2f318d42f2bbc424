"""Model grids on the Earth, and their resampling to the latitude and longitude axes of a run.

A grid that does not follow parallels and meridians keeps its cells if this moves none by more than half a
cell. Else each cell of a regular latitude-longitude grid takes the value of the nearest model cell: no value
changes, and the largest position error is reported.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...errors import Error
from ..areas import area_factors, metres_per_degree
from . import optional_packages

Array = NDArray[np.float64]
_ROWS = 256  # rows of the new grid that are looked up at once
_LARGEST = 1 << 28  # cells
_WIDE = 8


@dataclass(frozen=True, eq=False)
class Grid:
    """Cell centres in degrees: (ny,) and (nx,), or both (ny, nx); rows run north or south."""

    latitude: Array
    longitude: Array

    @classmethod
    def metres(cls, x: Array, y: Array, at: tuple[float, float]) -> Grid:
        """Create a grid from metres east (nx,) and north (ny,) of a point, with degrees at its parallel."""
        north, east = metres_per_degree(at[0])
        return cls(at[0] + np.asarray(y, np.float64) / north, at[1] + np.asarray(x, np.float64) / east)

    @classmethod
    def projected(cls, x: Array, y: Array, projection: str) -> Grid:
        """Create a grid from coordinates (nx,) and (ny,) in a projection.

        Raises
        ------
        Error
            PROJ does not know the projection, or pyproj is missing.
        """
        transformer = _pyproj(projection)
        if transformer.source_crs.is_geographic:
            return cls(np.asarray(y, np.float64), np.asarray(x, np.float64))
        longitude, latitude = transformer.transform(*np.meshgrid(x, y))
        return cls(latitude, longitude)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        if self.latitude.ndim == 2:
            rows, columns = self.latitude.shape
            return rows, columns
        return len(self.latitude), len(self.longitude)

    @cached_property
    def cell(self) -> tuple[float, float]:
        """Width and height of a cell near the centre, m."""
        north, east = metres_per_degree(float(np.mean(self.latitude)))
        sides = []
        for axis in (1, 0):
            steps = [np.diff(each, axis=min(axis, each.ndim - 1)) for each in self._both(axis)]
            lengths = np.hypot(steps[0] * north, steps[1] * east)
            sides.append(float(np.median(lengths)) if lengths.size else 0.0)
        width, height = sides
        return width or height or 100.0, height or width or 100.0

    def _both(self, axis: int) -> tuple[Array, Array]:
        if self.latitude.ndim == 2:
            return self.latitude, self.longitude
        along = self.longitude if axis else self.latitude
        return (np.zeros_like(along), along) if axis else (along, np.zeros_like(along))

    @cached_property
    def turn(self) -> tuple[NDArray[np.float32], NDArray[np.float32]] | None:
        """Grid convergence: cosine and sine (ny, nx) of the angle from east to rows; None if it is 0."""
        if self.latitude.ndim == 1:
            return None
        east = _slope(self.longitude, 1) * np.cos(np.radians(self.latitude))
        north = _slope(self.latitude, 1)
        size = np.hypot(east, north)
        return (east / size).astype(np.float32), (north / size).astype(np.float32)

    def east_north(self, u: NDArray, v: NDArray) -> tuple[NDArray, NDArray]:
        """Rotate wind along rows and columns (..., ny, nx) to east and north."""
        if self.turn is None:
            return u, v
        cosine, sine = self.turn
        return u * cosine - v * sine, u * sine + v * cosine

    @cached_property
    def areas(self) -> Array:
        """Cell areas (ny, nx), m2, of a grid with 2-D latitude and longitude."""
        latitude, longitude = self.latitude, self.longitude
        down, across = (np.stack([_slope(each, axis) for each in (latitude, longitude)]) for axis in (0, 1))
        middle = float(latitude.mean())
        north, east = metres_per_degree(middle)
        narrower = np.cos(np.radians(latitude)) / np.cos(np.radians(middle))
        return np.abs(down[0] * across[1] - down[1] * across[0]) * north * east * narrower

    @cached_property
    def placed(self) -> Placed:
        """Resample the grid to the axes of a run.

        Raises
        ------
        Error
            The positions are invalid.
        """
        for values, limit, name in ((self.latitude, 90.0, "latitude"), (self.longitude, 540.0, "longitude")):
            if values.size == 0 or values.size > _LARGEST:
                raise Error(f"a grid of {' x '.join(map(str, self.shape))} cells is invalid")
            if not np.isfinite(values).all() or np.abs(values).max() > limit:
                raise Error(
                    f"its {name}s are not valid positions on the Earth; the file is damaged or in other units"
                )
        return Placed(self.latitude, self.longitude) if self.latitude.ndim == 1 else _place(self)


@dataclass(frozen=True, eq=False)
class Placed:
    """Run axes, and the grid cell of each run cell (None: the same cells).

    Attributes
    ----------
    index, outside
        (ny, nx) of the run's cells: flat index of the grid cell, and whether the cell lies outside of the
        grid.
    areas
        Area of each grid cell, m2, if cells differ.
    error
        Position error in words; empty without one.
    """

    latitude: Array
    longitude: Array
    index: NDArray[np.int32] | None = None
    outside: NDArray[np.bool_] | None = None
    areas: Array | None = None
    error: str = ""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return len(self.latitude), len(self.longitude)

    def put(self, values: NDArray, fill: float | None) -> NDArray[np.float32]:
        """Resample values (..., grid) to run cells as float32; `fill` (None: nearest) outside of the grid."""
        values = np.asarray(values, np.float32)
        if self.index is None:
            return np.ascontiguousarray(values)
        flat = values.reshape(*values.shape[:-2], -1)
        resampled = np.take(flat, self.index, axis=-1)
        if fill is not None:
            resampled[..., self.outside] = fill
        return resampled

    def put_share(self, share: NDArray) -> NDArray[np.float32]:
        """Resample fractions (0..1) to run cells with the total area conserved, to float rounding.

        The area error of nearest-neighbour resampling is corrected in cells that are neither 0 nor 1.
        """
        share = np.nan_to_num(share)
        resampled = self.put(share, 0.0)
        if self.areas is None:
            return resampled
        strip, width = area_factors(self.latitude, self.longitude)
        area = np.where((resampled > 0) & (resampled < 1), strip[:, None] * width, 0.0)
        lacks = float((share * self.areas).sum()) - float(strip @ (resampled.astype(np.float64) @ width))
        room = (1 - resampled if lacks > 0 else resampled).astype(np.float64)
        most = float((room * area).sum())
        part = np.clip(lacks / most, -1.0, 1.0) if most > 0 else 0.0
        return (resampled + part * room * (area > 0)).astype(np.float32)


def _place(grid: Grid) -> Placed:
    latitude, longitude = grid.latitude, np.unwrap(grid.longitude, period=360.0, axis=1)
    longitude = np.unwrap(longitude, period=360.0, axis=0)
    north, east = metres_per_degree(float(latitude.mean()))
    rows, columns = latitude.mean(axis=1), longitude.mean(axis=0)
    off = np.hypot((latitude - rows[:, None]) * north, (longitude - columns[None, :]) * east).max()
    if off <= 0.5 * min(grid.cell) and _orderly(rows) and _orderly(columns):
        text = f"rows and columns are taken as parallels and meridians; cells are {off:.2g} m off at most"
        return Placed(rows, columns, error=text)
    if min(grid.shape) < 2:
        raise Error("a grid of one row or column must run north or east")
    side = float(np.sqrt(grid.cell[0] * grid.cell[1]))
    low, high = latitude.min(), latitude.max()
    left, right = longitude.min(), longitude.max()
    ny, nx = int(np.ceil((high - low) * north / side)) + 1, int(np.ceil((right - left) * east / side)) + 1
    if ny * nx > 16 * latitude.size + 1000:
        raise Error("its cells are scattered: latitudes and longitudes make no grid")
    rows, columns = low + np.arange(ny) * side / north, left + np.arange(nx) * side / east
    index = np.empty((ny, nx), np.int32)
    outside = np.empty((ny, nx), bool)
    off = 0.0
    nearest = _Nearest(latitude, longitude)
    for first in range(0, ny, _ROWS):
        part = slice(first, min(first + _ROWS, ny))
        i, j, outside[part] = nearest(rows[part, None], columns[None, :])
        index[part] = i * latitude.shape[1] + j
        away = np.hypot(
            (latitude[i, j] - rows[part, None]) * north, (longitude[i, j] - columns[None, :]) * east
        )
        off = max(off, float(away[~outside[part]].max(initial=0.0)))
    text = (
        f"its grid is turned or curved: {ny} x {nx} cells of {side:.4g} m along parallels and meridians take "
        f"the values of the nearest cells, which lie {off:.2g} m off at most; beyond the model's own cells "
        "ground and fuels go on as at its edge and nothing burns"
    )
    return Placed(rows, columns, index, outside, grid.areas, text)


class _Nearest:
    """Nearest cell of a smooth grid, by Newton's method on its own derivatives."""

    def __init__(self, latitude: Array, longitude: Array) -> None:
        self.place = latitude, longitude
        a, b, c, d = (_slope(each, axis) for each in (latitude, longitude) for axis in (0, 1))
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 1.0 / (a * d - b * c)
            self.inverse = d * scale, -b * scale, -c * scale, a * scale
        if not np.isfinite(scale).all():
            raise Error("its cells lie on each other: latitudes and longitudes make no grid")

    def __call__(
        self, latitude: Array, longitude: Array
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
        ny, nx = self.place[0].shape
        latitude, longitude = np.broadcast_arrays(latitude, longitude)
        i = np.full(latitude.shape, ny // 2)
        j = np.full(latitude.shape, nx // 2)
        for _ in range(8):
            north, east = latitude - self.place[0][i, j], longitude - self.place[1][i, j]
            di = self.inverse[0][i, j] * north + self.inverse[1][i, j] * east
            dj = self.inverse[2][i, j] * north + self.inverse[3][i, j] * east
            outside = (i + di < -0.5) | (i + di > ny - 0.5) | (j + dj < -0.5) | (j + dj > nx - 0.5)
            i_next = np.clip(np.rint(i + di), 0, ny - 1).astype(np.int64)
            j_next = np.clip(np.rint(j + dj), 0, nx - 1).astype(np.int64)
            if np.array_equal(i, i_next) and np.array_equal(j, j_next):
                break
            i, j = i_next, j_next
        return i, j, outside


def _slope(values: Array, axis: int) -> Array:
    """Compute the gradient per cell over several cells: 32-bit longitudes resolve 0.65 m."""
    count = values.shape[axis]
    at = np.arange(count)
    low, high = np.maximum(at - _WIDE, 0), np.minimum(at + _WIDE, count - 1)
    width = (high - low).reshape((-1, 1) if axis == 0 else (1, -1))
    return (np.take(values, high, axis) - np.take(values, low, axis)) / width


def _orderly(axis: Array) -> bool:
    steps = np.diff(axis)
    return bool((steps > 0).all() or (steps < 0).all())


def _pyproj(projection: str):  # noqa: ANN202
    pyproj = optional_packages.package("pyproj")
    try:
        return pyproj.Transformer.from_crs(projection, "EPSG:4326", always_xy=True)
    except pyproj.exceptions.CRSError as error:
        raise Error(f"the projection {projection!r} is not known ({' '.join(str(error).split())})") from None


def project(projection: str, latitude: Array, longitude: Array) -> tuple[Array, Array]:
    """Convert degrees to x and y in a projection."""
    transformer = _pyproj(projection)
    if transformer.source_crs.is_geographic:
        return longitude, latitude
    return transformer.transform(longitude, latitude, direction="INVERSE")
