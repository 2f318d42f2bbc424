"""Pixel grids of satellite imagers on the Earth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...run import areas

Array = NDArray[np.float64]

# GOES-R Product Definition and Users' Guide, volume 3, 5.1.2: GRS80 and the orbit, m.
EQUATOR, POLE, ORBIT = 6_378_137.0, 6_356_752.31414, 35_786_023.0
PIXEL = 56e-6  # rad, 2 km under the satellite


class ImagerGrid(Protocol):
    """Unbounded pixel grid: rows from north to south, columns from west to east."""

    @property
    def crs(self) -> str:
        """As PROJ reads it."""

    @property
    def step(self) -> tuple[float, float]:
        """Sizes of columns and rows, in units of `crs`."""

    def forward(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Fractional row and column of points (degrees); pixel i spans i to i + 1. NaN if not visible."""

    def reverse(self, row: ArrayLike, column: ArrayLike) -> tuple[Array, Array]:
        """Latitude and longitude (degrees) of fractional rows and columns; NaN off the Earth."""

    def corner(self, row: int, column: int) -> tuple[float, float]:
        """Return x and y, in units of `crs`, of a pixel's north-west corner."""


@dataclass(frozen=True)
class FixedGrid:
    """ABI fixed grid of a geostationary imager at a longitude (degrees): equal steps of scan angles."""

    longitude: float
    pixel: float = PIXEL

    @property
    def crs(self) -> str:
        """PROJ string; coordinates are scan angles times the orbit's height, m."""
        return f"+proj=geos +h={ORBIT:.0f} +lon_0={self.longitude:g} +sweep=x +ellps=GRS80 +units=m +no_defs"

    @property
    def step(self) -> tuple[float, float]:
        """Size of a column and a row in PROJ's coordinates, m."""
        return self.pixel * ORBIT, -self.pixel * ORBIT

    def angles(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Scan angles (rad) east and north of points on the ellipsoid (degrees)."""
        phi = np.arctan((POLE / EQUATOR) ** 2 * np.tan(np.radians(latitude)))
        turn = np.radians(np.asarray(longitude, np.float64) - self.longitude)
        squashed = 1.0 - (POLE / EQUATOR) ** 2
        radius = POLE / np.sqrt(1.0 - squashed * np.cos(phi) ** 2)
        far = ORBIT + EQUATOR
        x = far - radius * np.cos(phi) * np.cos(turn)
        y = -radius * np.cos(phi) * np.sin(turn)
        z = radius * np.sin(phi)
        seen = far * (far - x) >= y**2 + (EQUATOR / POLE) ** 2 * z**2
        east, north = np.arcsin(-y / np.sqrt(x**2 + y**2 + z**2)), np.arctan(z / x)
        return np.where(seen, east, np.nan), np.where(seen, north, np.nan)

    def forward(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Fractional row and column of points; the nadir is at row 0 and column 0."""
        east, north = self.angles(latitude, longitude)
        return -north / self.pixel, east / self.pixel

    def reverse(self, row: ArrayLike, column: ArrayLike) -> tuple[Array, Array]:
        """Latitude and longitude at which a line of sight meets the ellipsoid."""
        y = -self.pixel * np.asarray(row, np.float64)
        x = self.pixel * np.asarray(column, np.float64)
        far = ORBIT + EQUATOR
        flat = (EQUATOR / POLE) ** 2
        a = np.sin(x) ** 2 + np.cos(x) ** 2 * (np.cos(y) ** 2 + flat * np.sin(y) ** 2)
        b = -2.0 * far * np.cos(x) * np.cos(y)
        c = far**2 - EQUATOR**2
        with np.errstate(invalid="ignore"):
            distance = (-b - np.sqrt(b**2 - 4.0 * a * c)) / (2.0 * a)
        sx = distance * np.cos(x) * np.cos(y)
        sy, sz = -distance * np.sin(x), distance * np.cos(x) * np.sin(y)
        latitude = np.degrees(np.arctan(flat * sz / np.hypot(far - sx, sy)))
        return latitude, self.longitude - np.degrees(np.arctan(sy / (far - sx)))

    def corner(self, row: int, column: int) -> tuple[float, float]:
        """Return x and y in PROJ's coordinates."""
        return column * self.step[0], row * self.step[1]


@dataclass(frozen=True)
class EvenGrid:
    """Grid of equal steps of latitude and longitude, `size` m at a latitude, as of gridded swaths."""

    latitude: float
    size: float
    crs: str = "EPSG:4326"

    @property
    def step(self) -> tuple[float, float]:
        """Size of a column and a row, degrees."""
        north, east = areas.metres_per_degree(self.latitude)
        return self.size / east, -self.size / north

    def forward(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Fractional row and column of points."""
        east, south = self.step
        return np.asarray(latitude, np.float64) / south, np.asarray(longitude, np.float64) / east

    def reverse(self, row: ArrayLike, column: ArrayLike) -> tuple[Array, Array]:
        """Latitude and longitude of fractional rows and columns."""
        east, south = self.step
        latitude, longitude = np.broadcast_arrays(
            np.asarray(row, np.float64) * south, np.asarray(column, np.float64) * east
        )
        return latitude, longitude

    def corner(self, row: int, column: int) -> tuple[float, float]:
        """Longitude and latitude of a pixel's north-west corner."""
        return column * self.step[0], row * self.step[1]


def pixel_areas(grid: ImagerGrid, rows: NDArray, columns: NDArray) -> Array:
    """Ground area (rows, columns), m2, of the pixels at whole rows and columns."""
    corners = (np.append(each, each[-1] + 1) for each in (rows, columns))
    latitude, longitude = grid.reverse(*np.meshgrid(*corners, indexing="ij"))
    middle = float(np.nanmean(latitude))
    north, east = areas.metres_per_degree(middle)
    y = latitude * north
    x = longitude * east * np.cos(np.radians(latitude)) / np.cos(np.radians(middle))
    falling, rising = (
        (v[1:, 1:] - v[:-1, :-1] for v in (x, y)),
        (v[1:, :-1] - v[:-1, 1:] for v in (x, y)),
    )
    (fx, fy), (rx, ry) = falling, rising
    return 0.5 * np.abs(fx * ry - rx * fy)
