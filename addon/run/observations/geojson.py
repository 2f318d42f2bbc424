"""GeoJSON (RFC 7946): WGS84 degrees, east before north."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...errors import input_error
from .feature import Feature, Polygon, degrees, ring


def read(path: Path) -> list[Feature]:
    """The features of a FeatureCollection, of one Feature, or of a bare geometry.

    Raises
    ------
    InputError
        It is no GeoJSON, or of another reference system than degrees.
    """
    try:
        whole = json.loads(path.read_text(encoding="utf-8-sig"))
    except json.JSONDecodeError as error:
        raise input_error(path, error.lineno, error.colno, f"not valid JSON: {error.msg}") from None
    except (UnicodeDecodeError, RecursionError) as error:
        raise input_error(path, 0, 0, f"not valid JSON: {error}") from None
    if not isinstance(whole, dict) or "type" not in whole:
        raise input_error(path, 0, 0, 'no GeoJSON: it has no "type"')
    _check_degrees(path, whole)
    if whole["type"] == "FeatureCollection":
        features = whole.get("features")
        if not isinstance(features, list):
            raise input_error(path, 0, 0, 'no GeoJSON: its "features" are no list')
    else:
        features = [whole if whole["type"] == "Feature" else {"geometry": whole}]
    said = {name: each for name, each in whole.items() if isinstance(each, str | int | float)}
    return [_feature(path, f"feature {i}", each, said) for i, each in enumerate(features, 1)]


def _check_degrees(path: Path, whole: dict[str, Any]) -> None:
    """GeoJSON of before 2016 may name another reference system."""
    crs = whole.get("crs")
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = str(properties.get("name", "")) if isinstance(properties, dict) else ""
    if name and not name.endswith(("CRS84", ":4326", ":4269", ":4979")):
        raise input_error(path, 0, 0, f"is in {name}; save it in WGS84 (EPSG:4326)")


def _feature(path: Path, place: str, feature: Any, said: dict[str, Any]) -> Feature:
    """A feature; what is `said` of all of them, such as ForeFire's ``valid_at``, is said of it."""
    if not isinstance(feature, dict):
        raise input_error(path, 0, 0, f"{place} is no table")
    properties = feature.get("properties")
    return Feature(
        tuple(_polygons(path, place, feature.get("geometry"))),
        said | (properties if isinstance(properties, dict) else {}),
        place,
        degrees(path, place, list(_points(feature.get("geometry")))),
        tuple(degrees(path, place, each) for each in _lines(feature.get("geometry"))),
    )


def _lines(geometry: Any) -> Iterator[list[Any]]:
    if not isinstance(geometry, dict):
        return
    kind, parts = geometry.get("type"), geometry.get("coordinates")
    if kind == "LineString" and isinstance(parts, list):
        yield parts
    elif kind == "MultiLineString" and isinstance(parts, list):
        yield from (each for each in parts if isinstance(each, list))
    elif kind == "GeometryCollection" and isinstance(geometry.get("geometries"), list):
        for each in geometry["geometries"]:
            yield from _lines(each)


def _points(geometry: Any) -> Iterator[Any]:
    if not isinstance(geometry, dict):
        return
    parts = geometry.get("coordinates")
    if geometry.get("type") == "Point" and parts:
        yield parts
    elif geometry.get("type") == "MultiPoint" and isinstance(parts, list):
        yield from parts
    elif geometry.get("type") == "GeometryCollection" and isinstance(geometry.get("geometries"), list):
        for each in geometry["geometries"]:
            yield from _points(each)


def _polygons(path: Path, place: str, geometry: Any) -> Iterator[Polygon]:
    if not isinstance(geometry, dict):
        return
    kind = geometry.get("type")
    parts = geometry.get("geometries" if kind == "GeometryCollection" else "coordinates")
    if kind not in ("Polygon", "MultiPolygon", "GeometryCollection") or parts == []:
        return
    if not isinstance(parts, list):
        raise input_error(path, 0, 0, f"{place} is a {kind} without a list of what it is made of")
    if kind == "GeometryCollection":
        for part in parts:
            yield from _polygons(path, place, part)
        return
    for polygon in [parts] if kind == "Polygon" else parts:
        if not isinstance(polygon, list):
            raise input_error(path, 0, 0, f"{place} has a polygon that is no list of rings")
        if polygon:
            yield tuple(ring(path, place, each if isinstance(each, list) else [None]) for each in polygon)
