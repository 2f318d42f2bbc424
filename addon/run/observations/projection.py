"""Reprojection of coordinates in other reference systems to degrees, by pyproj if installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error

_DEGREES = ("EPSG:4326", "EPSG:4269", "OGC:CRS84")  # WGS84, and NAD83, which is within 2 m of it


def to_degrees(path: Path, system: str, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Reproject points (n, 2) to degrees (n, 2) east and north on WGS84.

    Parameters
    ----------
    system
        A code such as "EPSG:32610", or well-known text.

    Raises
    ------
    InputError
        pyproj is missing or does not know the system.
    """
    if system.upper() in _DEGREES or (system.startswith("GEOGCS") and _plain(system)):
        return points
    try:
        from pyproj import Transformer
        from pyproj.exceptions import ProjError
    except ModuleNotFoundError:
        name = system.split('"')[1] if '"' in system else system
        reason = (
            f"is in {name}: save it in WGS84 (EPSG:4326), or install pyproj (pip install 'firetwin[score]')"
        )
        raise input_error(path, reason) from None
    try:
        east, north = Transformer.from_crs(system, "EPSG:4326", always_xy=True).transform(*points.T)
    except ProjError as error:
        raise input_error(path, f"has a reference system that is none: {error}") from None
    return np.column_stack([east, north])


def _plain(text: str) -> bool:
    """Check whether well-known text means WGS84 or NAD83 degrees from Greenwich."""
    return any(name in text for name in ("WGS_1984", "WGS 84", "North_American_1983", "NAD83")) and (
        "0.0174532925" in text and '"Greenwich",0' in text.replace(" ", "")
    )
