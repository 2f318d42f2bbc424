"""WGS84 latitude, longitude and height <-> local east-north-up metres."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

class LocalFrame:
    """WGS84 to local east-north-up metres about one origin (degrees, degrees, metres)."""

    def __init__(self, latitude: float, longitude: float, height: float = 0.0) -> None: ...
    @property
    def latitude(self) -> float:
        """Of the origin, degrees north."""
    @property
    def longitude(self) -> float:
        """Of the origin, degrees east."""
    @property
    def height(self) -> float:
        """Of the origin, m above the ellipsoid."""
    def forward(self, latitude: ArrayLike, longitude: ArrayLike, height: ArrayLike) -> NDArray[np.float64]:
        """Geodetic (n,) degrees, degrees, metres -> (n, 3) east, north, up in metres."""
    def forward_grid(
        self, latitude: ArrayLike, longitude: ArrayLike, height: ArrayLike
    ) -> NDArray[np.float64]:
        """Rectilinear grid: latitude (ny,), longitude (nx,), height (ny, nx) -> (ny, nx, 3) metres."""
    def reverse(self, enu: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """(n, 3) metres -> latitude (n,), longitude (n,), height (n,)."""

class HeightField:
    """The ground as heights on a rectilinear grid in local metres, bilinear between its nodes.

    `x` (nx,) and `y` (ny,) ascend or descend, `height` (ny, nx) m; there is no ground where it is not finite.
    """

    def __init__(self, x: ArrayLike, y: ArrayLike, height: ArrayLike) -> None: ...
    def at(self, place: ArrayLike) -> NDArray[np.float64]:
        """(n, 2) metres -> (n,) height, that of the nearest edge outside the grid, NaN without ground."""
