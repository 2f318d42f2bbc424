"""Local east-north-up metres, UTM and geodesics on WGS84, and ground heights.

Arguments of functions of places broadcast; results have their common shape.
"""

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

class Utm:
    """Universal Transverse Mercator on WGS84 in one zone, also beyond its borders (GeographicLib).

    `zone` is 1 to 60; `south` adds 10,000 km to northings. Within 5 nm for 3900 km from the central meridian.
    """

    def __init__(self, zone: int, south: bool) -> None: ...
    def forward(
        self, latitude: ArrayLike, longitude: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Project degrees to east and north, m, and compute the convergence.

        The convergence is the angle from true north to grid north, degrees clockwise.
        """
    def reverse(self, east: ArrayLike, north: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Convert east and north (m) to latitude and longitude, degrees.

        Longitudes are within 180 degrees of the central meridian.
        """
    def square(self, east: float, north: float) -> str:
        """Name the grid zone and 100 km square of a point (m) by MGRS: ``10SFJ``; empty outside the grid."""

def utm_zone(latitude: float, longitude: float) -> int:
    """Find the UTM zone of a place (degrees), 1 to 60, with the exceptions for Norway and Svalbard."""

def geodesic_inverse(
    latitude: ArrayLike, longitude: ArrayLike, to_latitude: ArrayLike, to_longitude: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Compute geodesics between points, in degrees (Karney 2013, J. Geod. 87, 43-55; within 15 nm).

    Returns
    -------
    Lengths, m, and azimuths at the first and last points, degrees clockwise from north; 0 for a length of 0.
    """

def geodesic_direct(
    latitude: ArrayLike, longitude: ArrayLike, azimuth: ArrayLike, length: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Compute end points of geodesics from points (degrees), azimuths (degrees) and lengths (m).

    Returns
    -------
    Latitude, longitude in [-180, 180] and azimuth at the end, degrees.
    """
