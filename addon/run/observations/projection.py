"""Conversion of coordinates in other reference systems to degrees on WGS84.

Degrees, Web Mercator and UTM need no package; other systems need pyproj. Grids of WGS84 and NAD83 are within
2 m of each other.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ... import extras
from ...errors import input_error
from ...geometry import mercator
from ...geometry.utm import Zone

Array = NDArray[np.float64]

_DEGREES = ("EPSG:4326", "EPSG:4269", "EPSG:4979", "CRS:84", "OGC:CRS84")
_WEB_MERCATOR = ("EPSG:3857", "EPSG:900913", "EPSG:3785", "EPSG:102100", "EPSG:102113")
UNDEFINED = ("", "undefined", "Undefined")
"""Definitions of GeoPackages without a reference system."""


def to_degrees(path: Path, system: str, points: Array) -> Array:
    """Convert points (n, 2) to degrees (n, 2) east and north on WGS84.

    Parameters
    ----------
    system
        A code such as "EPSG:32610" or "urn:ogc:def:crs:EPSG::32610", or well-known text.

    Raises
    ------
    InputError
        The system is undefined, or pyproj is missing or does not know it.
    """
    code = normalise(system)
    if code in _DEGREES or (system.startswith("GEOGCS") and _is_plain(system)):
        return points
    if code in _WEB_MERCATOR:
        return np.column_stack(mercator.inverse(*points.T)[::-1])
    if zone := _utm_zone(code):
        return np.column_stack(zone.inverse(*points.T)[::-1])
    if system in UNDEFINED:
        raise input_error(path, "has no reference system; save it in WGS84 (EPSG:4326)")
    try:
        from pyproj import Transformer
        from pyproj.exceptions import ProjError
    except ModuleNotFoundError:
        name = system.split('"')[1] if '"' in system else system
        reason = f"is in {name}: save it in WGS84 (EPSG:4326), or install pyproj ({extras.install('score')})"
        raise input_error(path, reason) from None
    try:
        east, north = Transformer.from_crs(code, "EPSG:4326", always_xy=True).transform(*points.T)
    except ProjError as error:
        raise input_error(path, f"has a reference system that is none: {error}") from None
    return np.column_stack([east, north])


def normalise(system: str) -> str:
    """Return a code such as "EPSG:3857" for the ways in which files write it; other texts unchanged."""
    match = re.fullmatch(
        r"(?:urn:ogc:def:crs:)?(EPSG|ESRI|OGC|CRS):(?:[\d.]*:)?(CRS84|84|\d+)", system.strip(), re.I
    )
    if not match:
        return system
    body, number = match[1].upper(), match[2].upper()
    return f"EPSG:{number}" if body == "ESRI" and f"EPSG:{number}" in _WEB_MERCATOR else f"{body}:{number}"


def _utm_zone(code: str) -> Zone | None:
    """Return the UTM zone of a code of WGS84, or of NAD83 in America; else None."""
    match = re.fullmatch(r"EPSG:(326|327|269)(\d\d)", code)
    if not match or not 1 <= (number := int(match[2])) <= (23 if match[1] == "269" else 60):
        return None
    return Zone(number, south=match[1] == "327")


def _is_plain(text: str) -> bool:
    """Check whether well-known text means WGS84 or NAD83 degrees from Greenwich."""
    return any(name in text for name in ("WGS_1984", "WGS 84", "North_American_1983", "NAD83")) and (
        "0.0174532925" in text and '"Greenwich",0' in text.replace(" ", "")
    )
