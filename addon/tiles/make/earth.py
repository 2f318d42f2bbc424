"""Earth-centred coordinates of places on the WGS84 ellipsoid."""

from __future__ import annotations

import numpy as np
from firetwin_core import constants, geo
from numpy.typing import NDArray

Array = NDArray[np.float64]

_GREENWICH = geo.LocalFrame(0.0, 0.0, 0.0)


def centred(latitude: Array, longitude: Array, height: Array) -> Array:
    """Earth-centred, Earth-fixed coordinates (n, 3), m, of places (n,) in degrees and m above the ellipsoid.

    They are those of the local frame at 0 N 0 E, whose axes are turned and whose origin lies on the equator.
    """
    east, north, up = _GREENWICH.forward(latitude, longitude, height).T
    return np.column_stack([up + constants.SEMI_MAJOR_AXIS, east, north])


def axes(latitude: Array, longitude: Array) -> tuple[Array, Array, Array]:
    """Unit vectors east, north and up (..., 3) at places in degrees (Snyder 1987, chapter 4)."""
    lat, lon = np.radians(latitude), np.radians(longitude)
    zero = np.zeros(np.broadcast(lat, lon).shape)
    east = np.stack([-np.sin(lon) + zero, np.cos(lon) + zero, zero], axis=-1)
    north = np.stack([-np.sin(lat) * np.cos(lon), -np.sin(lat) * np.sin(lon), np.cos(lat) + zero], axis=-1)
    up = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat) + zero], axis=-1)
    return east, north, up
