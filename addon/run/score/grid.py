"""Fuel grid of a run for scores: arrival times, cell areas, and the burned polygon at a time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import areas, burned_fraction
from . import shapes

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


@dataclass(frozen=True)
class ScoreGrid:
    """Cell centres (degrees, from south and west) and arrival times (ny, nx), s, NaN where never.

    `fraction` returns the burned fraction (ny, nx) at a model time (s), for runs that have it.
    """

    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    arrival: NDArray[np.float64]
    fraction: Callable[[float], NDArray] | None = None

    @classmethod
    def of(cls, run: Run) -> ScoreGrid:
        """Grid of a run, with arrival times from the core."""
        latitude, longitude, time = run.fuel_latitude, run.fuel_longitude, run.fuel_arrival_time()
        south, west = latitude[0] > latitude[-1], longitude[0] > longitude[-1]
        rows, columns = slice(None, None, -1 if south else 1), slice(None, None, -1 if west else 1)
        known = None
        if run.has(burned_fraction.FIELD):
            known = lambda moment: burned_fraction.at(run, moment)[rows, columns]  # noqa: E731
        return cls(latitude[rows], longitude[columns], np.asarray(time, np.float64)[rows, columns], known)

    @property
    def middle(self) -> float:
        """Central meridian, degrees east."""
        return float(self.longitude[0] + self.longitude[-1]) / 2

    @cached_property
    def cell(self) -> tuple[float, float]:
        """Cell width and height, m."""
        return areas.cell_size(self.latitude, self.longitude)

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Cell areas (ny, nx), m2."""
        return areas.cell_areas(self.latitude, self.longitude)

    @property
    def domain(self) -> float:
        """Total area, m2."""
        return float(self.areas.sum())

    @cached_property
    def projection(self) -> shapes.Projection:
        """Equal-area projection about the centre."""
        return shapes.Projection(float(self.latitude[0] + self.latitude[-1]) / 2, self.middle)

    @cached_property
    def box(self) -> BaseGeometry:
        """Outline of the grid, projected."""
        y, x = areas.edges(self.latitude), areas.edges(self.longitude)
        return self.projection.project(shapes.outline(x, y))

    def at(
        self, latitude: NDArray[np.float64], longitude: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Rows and columns of the cells that contain latitudes and longitudes (degrees), -1 outside."""
        turned = areas.turned(longitude, self.middle)
        return _nearest(self.latitude, latitude), _nearest(self.longitude, turned)

    def burned(self, time: float) -> NDArray[np.floating] | NDArray[np.bool_]:
        """Burned fraction (ny, nx) at a model time (s); else whether the front has reached cell centres."""
        if self.fraction is not None:
            return self.fraction(time)
        return self.arrival <= time  # False for NaN

    def inside(self, shape: BaseGeometry) -> NDArray[np.bool_]:
        """Mask (ny, nx) of cells with their centre in a shape in degrees."""
        return shapes.contains(shape, self.longitude, self.latitude)

    def polygon(self, time: float) -> BaseGeometry:
        """Burned polygon at a model time (s), projected, with the front interpolated between cell centres."""
        return self.projection.project(shapes.of_front(self.longitude, self.latitude, self.arrival - time))

    def degrees(self, shape: BaseGeometry) -> BaseGeometry:
        """Convert a projected shape to degrees."""
        return self.projection.project(shape, back=True)


def _nearest(axis: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.int64]:
    """Index of the cell that contains each value, -1 outside; the axis ascends."""
    middles = (axis[1:] + axis[:-1]) / 2
    index = np.searchsorted(middles, at)
    half = (axis[1] - axis[0]) / 2 if axis.size > 1 else np.inf
    return np.where((at < axis[0] - half) | (at > axis[-1] + half), -1, index)
