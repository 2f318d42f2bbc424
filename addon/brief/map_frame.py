"""Frame of the map sheet: projection, scale and extent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ..geometry.utm import Zone
from .mercator import Box

Array = NDArray[np.float64]

_RATIOS = (1.0, 1.2, 1.5, 2.0, 2.4, 2.5, 3.0, 3.168, 4.0, 5.0, 6.0, 6.336, 7.5, 8.0, 10.0)
"""Scales of common maps times a power of ten: 1:24,000, 1:31,680 (2 in = 1 mi), 1:63,360 (1 in = 1 mi)."""

_NODES = 41  # exact points along each side of a picture


@dataclass(frozen=True)
class MapFrame:
    """Rectangle on the paper that shows a part of a UTM zone, with grid north up.

    Attributes
    ----------
    ratio
        Denominator of the scale.
    left, top, width, height
        Rectangle on the sheet, mm.
    west, north
        UTM coordinates of its upper left corner, m.
    """

    zone: Zone
    ratio: float
    left: float
    top: float
    width: float
    height: float
    west: float
    north: float

    @classmethod
    def fitted(cls, box: Box, rectangle: tuple[float, float, float, float]) -> MapFrame:
        """Choose the largest common scale at which a rectangle (left, top, width, height; mm) shows a box."""
        left, top, width, height = rectangle
        middle = 0.5 * (box.south + box.north), 0.5 * (box.west + box.east)
        zone = Zone.at(*middle)
        edge = np.linspace(0.0, 1.0, 9)
        latitude, longitude = np.meshgrid(
            box.south + edge * (box.north - box.south), box.west + edge * (box.east - box.west)
        )
        east, north = zone.forward(latitude, longitude)
        across, along = float(np.ptp(east)), float(np.ptp(north))
        ratio = round_ratio(1000.0 * max(across / width, along / height))
        metres = ratio / 1000.0
        middle_east, middle_north = float(east.min()) + 0.5 * across, float(north.min()) + 0.5 * along
        west = middle_east - 0.5 * width * metres
        return cls(zone, ratio, left, top, width, height, west, middle_north + 0.5 * height * metres)

    @property
    def metres(self) -> float:
        """Metres on the ground for 1 mm of the sheet."""
        return self.ratio / 1000.0

    @property
    def east(self) -> float:
        """UTM coordinate of the right edge, m."""
        return self.west + self.width * self.metres

    @property
    def south(self) -> float:
        """UTM coordinate of the lower edge, m."""
        return self.north - self.height * self.metres

    @property
    def middle(self) -> tuple[float, float]:
        """Latitude and longitude of the middle, degrees."""
        latitude, longitude = self.zone.inverse(
            0.5 * (self.west + self.east), 0.5 * (self.south + self.north)
        )
        return float(latitude), float(longitude)

    def to_sheet(self, east: ArrayLike, north: ArrayLike) -> tuple[Array, Array]:
        """Convert UTM coordinates (m) to positions on the sheet, mm right and down."""
        x = self.left + (np.asarray(east, np.float64) - self.west) / self.metres
        return x, self.top + (self.north - np.asarray(north, np.float64)) / self.metres

    def place(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Convert degrees to positions on the sheet, mm right and down."""
        return self.to_sheet(*self.zone.forward(latitude, longitude))

    def contains(self, x: float, y: float, margin: float = 0.0) -> bool:
        """Check whether a position on the sheet (mm) lies in the frame, `margin` mm from its edges."""
        inside = self.left + margin <= x <= self.left + self.width - margin
        return inside and self.top + margin <= y <= self.top + self.height - margin

    def pixels(self, columns: int) -> tuple[Array, Array]:
        """Compute latitudes and longitudes of the pixels of a picture of the frame, both (rows, columns).

        They are interpolated between exact nodes; within 100 km of sheet the error is below 1 m.
        """
        rows = max(round(columns * self.height / self.width), 1)
        node = np.linspace(0.0, 1.0, _NODES)
        east, north = (
            self.west + node * (self.east - self.west),
            self.north + node * (self.south - self.north),
        )
        exact = self.zone.inverse(*np.meshgrid(east, north))
        row, column = (((np.arange(size) + 0.5) / size * (_NODES - 1)) for size in (rows, columns))
        latitude, longitude = (bilinear(each, row[:, None], column) for each in exact)
        return latitude, longitude


def round_ratio(least: float) -> float:
    """Round the denominator of a scale up to the scale of a common map."""
    unit = 10.0 ** np.floor(np.log10(least))
    return float(round(next(each * unit for each in _RATIOS if each * unit >= least * (1.0 - 1e-9))))
