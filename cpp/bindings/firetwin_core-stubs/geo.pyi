"""Conversion between WGS84 and local east-north-up metres, and ground heights."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

class LocalFrame:
    """Local east-north-up frame with an origin in WGS84 (degrees, degrees, metres above the ellipsoid)."""

    def __init__(self, latitude: float, longitude: float, height: float = 0.0) -> None: ...
    @property
    def latitude(self) -> float:
        """Latitude of the origin, degrees north."""
    @property
    def longitude(self) -> float:
        """Longitude of the origin, degrees east."""
    @property
    def height(self) -> float:
        """Height of the origin, m above the ellipsoid."""
    def forward(self, latitude: ArrayLike, longitude: ArrayLike, height: ArrayLike) -> NDArray[np.float64]:
        """Convert points (n,) in degrees, degrees and metres to (n, 3) east, north and up, m."""
    def forward_grid(
        self, latitude: ArrayLike, longitude: ArrayLike, height: ArrayLike
    ) -> NDArray[np.float64]:
        """Convert a rectilinear grid, latitude (ny,), longitude (nx,), height (ny, nx), to (ny, nx, 3) m."""
    def reverse(self, enu: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Convert (n, 3) metres to latitude (n,), longitude (n,) and height (n,)."""

class HeightField:
    """Ground heights on a rectilinear grid in local metres, interpolated bilinearly.

    `x` (nx,) and `y` (ny,) are strictly ascending or descending; `height` (ny, nx) is in metres. Heights that
    are not finite mean no ground.
    """

    def __init__(self, x: ArrayLike, y: ArrayLike, height: ArrayLike) -> None: ...
    def at(self, place: ArrayLike) -> NDArray[np.float64]:
        """Interpolate heights (n,) at points (n, 2), m; clamped to the grid, NaN without ground."""
