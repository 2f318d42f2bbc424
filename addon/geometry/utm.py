"""Universal Transverse Mercator on WGS84, and names of US National Grid squares.

The US National Grid (FGDC-STD-011-2001) has the letters of MGRS (NGA.STND.0037_2.0.0_GRIDS) on WGS84.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import geo
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Zone:
    """A UTM zone.

    Attributes
    ----------
    number
        1 to 60.
    south
        True for northings with a false northing of 10,000 km.
    """

    number: int
    south: bool

    @classmethod
    def at(cls, latitude: float, longitude: float) -> Zone:
        """Choose the zone of a place (degrees), with the exceptions for Norway and Svalbard."""
        return cls(geo.utm_zone(latitude, longitude), latitude < 0.0)

    @property
    def epsg(self) -> int:
        """EPSG code of the zone on WGS84."""
        return (32700 if self.south else 32600) + self.number

    @property
    def name(self) -> str:
        """Zone and hemisphere: ``10N``."""
        return f"{self.number}{'S' if self.south else 'N'}"

    def forward(self, latitude: ArrayLike, longitude: ArrayLike) -> tuple[Array, Array]:
        """Project degrees to east and north, m."""
        return self._utm.forward(latitude, longitude)[:2]

    def inverse(self, east: ArrayLike, north: ArrayLike) -> tuple[Array, Array]:
        """Convert east and north (m) to latitude and longitude, degrees; longitudes near the meridian's."""
        return self._utm.reverse(east, north)

    def convergence(self, latitude: float, longitude: float) -> float:
        """Compute the angle from true north to grid north at a place, degrees clockwise."""
        return float(self._utm.forward(latitude, longitude)[2])

    def square(self, east: float, north: float) -> str:
        """Name the grid zone and 100 km square of UTM coordinates (m): ``10S FJ``; empty outside."""
        name = self._utm.square(east, north)
        return f"{name[:3].lstrip('0')} {name[3:]}" if name else ""

    @property
    def _utm(self) -> geo.Utm:
        return geo.Utm(self.number, self.south)
