"""The scene's one local frame: Blender's x, y, z are east, north, up in metres."""

from __future__ import annotations

import numpy as np
from firetwin_core import geo
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray


def local_frame(run: Run) -> geo.LocalFrame:
    """Frame whose origin is the centre of the run's model grid, at height 0.

    z is not height above sea level away from the origin: the Earth's curvature is in it (-50 m at 25 km).
    """
    latitude, longitude = run.latitude, run.longitude
    return geo.LocalFrame((latitude[0] + latitude[-1]) / 2, (longitude[0] + longitude[-1]) / 2, 0.0)


def metres_per_degree(latitude: float) -> tuple[float, float]:
    """Metres per degree of latitude and of longitude on the WGS84 ellipsoid (radii of curvature M and N)."""
    a, e2 = 6_378_137.0, 0.00669437999014
    sine = np.sin(np.radians(latitude))
    w = np.sqrt(1.0 - e2 * sine * sine)
    degree = np.pi / 180.0
    return a * (1.0 - e2) / w**3 * degree, a / w * np.cos(np.radians(latitude)) * degree


def geodetic_at(
    frame: geo.LocalFrame, east: ArrayLike, north: ArrayLike, up: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Latitude, longitude (degrees) and height (m) of scene points, each (n,)."""
    points = np.stack(np.broadcast_arrays(east, north, up), axis=-1).reshape(-1, 3)
    return frame.reverse(np.ascontiguousarray(points, dtype=np.float64))
