"""Geometry blobs of a GeoPackage (OGC 12-128, 2.1.3): header and well-known binary, degrees on WGS84."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from .schema import WGS84

Polygons = tuple[tuple[NDArray[np.float64], ...], ...]

_POINT, _POLYGON, _MULTIPOLYGON = 1, 3, 6
_PLAIN = struct.Struct("<2sBBiBIdd")  # point without an envelope
_BOXED = struct.Struct("<2sBBi4d")
_SHAPE = struct.Struct("<BII")
_LITTLE, _BOX_XY = 0x01, 0x02  # flags: byte order; an envelope of x and y


def point(latitude: float, longitude: float) -> bytes:
    """Encode a point."""
    return _PLAIN.pack(b"GP", 0, _LITTLE, WGS84, 1, _POINT, longitude, latitude)


def multipolygon(polygons: Polygons) -> bytes:
    """Encode polygons; rings (n, 2) are degrees east and north, and are closed here."""
    corners = np.concatenate([rings[0] for rings in polygons])
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    parts = [_BOXED.pack(b"GP", 0, _LITTLE | _BOX_XY, WGS84, west, east, south, north)]
    parts.append(_SHAPE.pack(1, _MULTIPOLYGON, len(polygons)))
    for rings in polygons:
        parts.append(_SHAPE.pack(1, _POLYGON, len(rings)))
        for ring in rings:
            closed = np.concatenate([ring, ring[:1]])
            parts += [struct.pack("<I", len(closed)), closed.astype("<f8").tobytes()]
    return b"".join(parts)


def position(blob: bytes) -> tuple[float, float] | None:
    """Decode latitude and longitude of a point as `point` and GDAL write it; None for another blob."""
    if len(blob) != _PLAIN.size:
        return None
    magic, _, flags, _, order, kind, x, y = _PLAIN.unpack(blob)
    if magic != b"GP" or flags != _LITTLE or order != 1 or kind != _POINT:
        return None
    return y, x
