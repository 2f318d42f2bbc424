"""Invented land for the gallery's fires: relief, fuel models and canopies on square cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin.data.fractal import fractal
from firetwin.run.areas import metres_per_degree
from firetwin.run.models import fuels
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROAD, WATER, BARE = (
    91,
    98,
    99,
)  # fuel models that do not burn (Scott and Burgan 2005, RMRS-GTR-153)


@dataclass
class Land:
    """Cells (ny, nx), rows from the south.

    Attributes
    ----------
    at
        Latitude and longitude of the middle, degrees.
    cell
        Side of a cell, m.
    elevation
        m above the sea.
    category
        Fuel models' numbers (Scott and Burgan 2005).
    cover, height, base, density
        Canopy: share of the ground, m, m above the ground, kg/m3; 0 where there is none.
    """

    at: tuple[float, float]
    cell: float
    elevation: Array
    category: NDArray[np.int64]
    cover: Array
    height: Array
    base: Array
    density: Array

    @classmethod
    def of(cls, at: tuple[float, float], cell: float, elevation: Array, category: NDArray) -> Land:
        """Land without canopy."""
        none = [np.zeros(elevation.shape) for _ in range(4)]
        return cls(at, cell, elevation, category.astype(np.int64), *none)

    def wooded(self, where: NDArray, cover: float, height: float, base: float, density: float) -> Land:
        """The same with a canopy where a mask (ny, nx) says so."""
        for name, value in (
            ("cover", cover),
            ("height", height),
            ("base", base),
            ("density", density),
        ):
            setattr(self, name, np.where(where, value, getattr(self, name)))
        return self

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.elevation.shape

    @property
    def axes(self) -> tuple[Array, Array]:
        """Degrees of latitude (ny,) and longitude (nx,) of the cells' middles."""
        (ny, nx), (north, east) = self.shape, metres_per_degree(self.at[0])
        rows, columns = (np.arange(n) - (n - 1) / 2 for n in (ny, nx))
        return self.at[0] + rows * self.cell / north, self.at[1] + columns * self.cell / east

    @property
    def surface_fuel(self) -> NDArray[np.float32]:
        """kg/m2: the whole load of each fuel model."""
        return fuels.loads(self.category)

    @property
    def canopy_fuel(self) -> Array:
        """kg/m2: bulk density times the crowns' depth."""
        return self.density * np.maximum(self.height - self.base, 0.0)

    @property
    def slope_and_aspect(self) -> tuple[Array, Array]:
        """Rise over run, and the direction downhill, degrees clockwise from north."""
        up, right = np.gradient(self.elevation, self.cell)
        return np.hypot(up, right), np.degrees(np.arctan2(-right, -up)) % 360.0

    def places(self) -> tuple[Array, Array]:
        """Metres east and north (ny, nx) of the middle."""
        (ny, nx), half = self.shape, 0.5
        y, x = ((np.arange(n) - n * half + half) * self.cell for n in (ny, nx))
        return np.meshgrid(x, y)

    def near(self, east: float, north: float, radius: float) -> NDArray[np.bool_]:
        """The cells within a radius (m) of a place, at least the nearest one."""
        x, y = self.places()
        distance = np.hypot(x - east, y - north)
        return distance <= max(radius, distance.min())


def hills(shape: tuple[int, int], cell: float, seed: int, longest: float, relief: float) -> Array:
    """Eroded relief with a standard deviation (m), no wavelength longer than `longest` m."""
    return relief * fractal(shape, seed, longest / cell, 3.0, 2.0)


def patches(
    shape: tuple[int, int],
    cell: float,
    seed: int,
    longest: float,
    shares: dict[int, float],
) -> NDArray:
    """Fuel models (ny, nx) in patches: each model on its share of the cells."""
    noise = fractal(shape, seed, longest / cell, 2.0, 1.2)
    order = noise.ravel().argsort().argsort() / noise.size
    bounds = np.cumsum(list(shares.values())) / sum(shares.values())
    return np.array(list(shares))[
        np.searchsorted(bounds, order.reshape(shape), side="right").clip(0, len(shares) - 1)
    ]
