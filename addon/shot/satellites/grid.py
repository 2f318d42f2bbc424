"""Where pixels of a satellite's imager lie on Earth."""

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


class Grid(Protocol):
    """Rows (north to south) and columns (west to east) of pixels, of unbounded number."""

    @property
    def crs(self) -> str:
        """As PROJ reads it."""

    @property
    def step(self) -> tuple[float, float]:
        """Of columns and rows, in units of `crs`."""

    def forward(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Fractional row and column of places (degrees); pixel i reaches from i to i + 1. NaN: not seen."""

    def reverse(self, row: ArrayLike, column: ArrayLike) -> tuple[Array, Array]:
        """Latitude and longitude (degrees) of fractional rows and columns; NaN beside the Earth."""

    def corner(self, row: int, column: int) -> tuple[float, float]:
        """Return x and y in units of `crs` of a pixel's corner in the north-west."""


@dataclass(frozen=True)
class FixedGrid:
    """The fixed grid of a geostationary imager at a longitude (degrees): equal steps of its scan angles."""

    longitude: float
    pixel: float = PIXEL

    @property
    def crs(self) -> str:
        """As PROJ reads it: scan angles times the height of the orbit, in metres."""
        return f"+proj=geos +h={ORBIT:.0f} +lon_0={self.longitude:g} +sweep=x +ellps=GRS80 +units=m +no_defs"

    @property
    def step(self) -> tuple[float, float]:
        """Metres that PROJ gives a column and a row."""
        return self.pixel * ORBIT, -self.pixel * ORBIT

    def angles(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Scan angles (rad) east and north of places on the ellipsoid (degrees)."""
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
        """Fractional row and column of places; the satellite stands where row and column are 0."""
        east, north = self.angles(latitude, longitude)
        return -north / self.pixel, east / self.pixel

    def reverse(self, row: ArrayLike, column: ArrayLike) -> tuple[Array, Array]:
        """Latitude and longitude where a line of sight meets the ellipsoid."""
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
        """Return x and y of PROJ's coordinates."""
        return column * self.step[0], row * self.step[1]


@dataclass(frozen=True)
class EvenGrid:
    """Pixels of equal steps of latitude and longitude, `size` m at a latitude: swaths as they are gridded."""

    latitude: float
    size: float
    crs: str = "EPSG:4326"

    @property
    def step(self) -> tuple[float, float]:
        """Degrees of a column and a row."""
        north, east = areas.metres_per_degree(self.latitude)
        return self.size / east, -self.size / north

    def forward(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Fractional row and column of places."""
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
        """Longitude and latitude."""
        return column * self.step[0], row * self.step[1]


def pixel_areas(grid: Grid, rows: NDArray, columns: NDArray) -> Array:
    """(rows, columns) m2 on the ground of the pixels that begin at whole rows and columns."""
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
