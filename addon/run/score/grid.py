"""Arrival grid of a run for scores: projection, and the burned polygon at a time."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .. import areas
from ..arrival_grid import ArrivalGrid
from . import shapes

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


class ScoreGrid(ArrivalGrid):
    """Arrival grid whose burned area is also available as a polygon."""

    @cached_property
    def projection(self) -> shapes.Projection:
        """Equal-area projection about the centre."""
        return shapes.Projection(float(self.latitude[0] + self.latitude[-1]) / 2, self.middle)

    @cached_property
    def box(self) -> BaseGeometry:
        """Outline of the grid, projected."""
        y, x = areas.edges(self.latitude), areas.edges(self.longitude)
        return self.projection.project(shapes.outline(x, y))

    def inside(self, shape: BaseGeometry) -> NDArray[np.bool_]:
        """Return a mask (ny, nx) of cells with their centre in a shape in degrees."""
        return shapes.contains(shape, self.longitude, self.latitude)

    def polygon(self, time: float) -> BaseGeometry:
        """Return the burned polygon at a model time (s), projected.

        The front is interpolated between cell centres.
        """
        return self.projection.project(shapes.of_front(self.longitude, self.latitude, self.arrival - time))

    def degrees(self, shape: BaseGeometry) -> BaseGeometry:
        """Convert a projected shape to degrees."""
        return self.projection.project(shape, back=True)
