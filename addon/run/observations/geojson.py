"""GeoJSON (RFC 7946): WGS84 degrees, longitude before latitude."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...errors import input_error
from .feature import Feature, Polygon, degrees, ring


def read(path: Path) -> list[Feature]:
    """Read the features of a FeatureCollection, a Feature or a bare geometry.

    Raises
    ------
    InputError
        The file is not GeoJSON, or has another reference system than degrees.
    """
    try:
        whole = json.loads(path.read_text(encoding="utf-8-sig"))
    except json.JSONDecodeError as error:
        raise input_error(
            path, f"not valid JSON: {error.msg}", line=error.lineno, column=error.colno
        ) from None
    except (UnicodeDecodeError, RecursionError) as error:
        raise input_error(path, f"not valid JSON: {error}") from None
    if not isinstance(whole, dict) or "type" not in whole:
        raise input_error(path, 'no GeoJSON: it has no "type"')
    _check_degrees(path, whole)
    if whole["type"] == "FeatureCollection":
        features = whole.get("features")
        if not isinstance(features, list):
            raise input_error(path, 'not GeoJSON: its "features" are not a list')
    else:
        features = [whole if whole["type"] == "Feature" else {"geometry": whole}]
    said = {name: item for name, item in whole.items() if isinstance(item, str | int | float)}
    return [_feature(path, f"feature {i}", item, said) for i, item in enumerate(features, 1)]


def _check_degrees(path: Path, whole: dict[str, Any]) -> None:
    """Check the reference system, which GeoJSON of before 2016 may name."""
    crs = whole.get("crs")
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = str(properties.get("name", "")) if isinstance(properties, dict) else ""
    if name and not name.endswith(("CRS84", ":4326", ":4269", ":4979")):
        raise input_error(path, f"is in {name}; save it in WGS84 (EPSG:4326)")


def _feature(path: Path, place: str, feature: Any, said: dict[str, Any]) -> Feature:
    """Parse a feature; collection properties `said`, such as ForeFire's ``valid_at``, apply to it."""
    if not isinstance(feature, dict):
        raise input_error(path, f"{place} is no table")
    properties = feature.get("properties")
    return Feature(
        tuple(_polygons(path, place, feature.get("geometry"))),
        said | (properties if isinstance(properties, dict) else {}),
        place,
        degrees(path, place, list(_points(feature.get("geometry")))),
        tuple(degrees(path, place, line) for line in _lines(feature.get("geometry"))),
    )


def _lines(geometry: Any) -> Iterator[list[Any]]:
    if not isinstance(geometry, dict):
        return
    kind, parts = geometry.get("type"), geometry.get("coordinates")
    if kind == "LineString" and isinstance(parts, list):
        yield parts
    elif kind == "MultiLineString" and isinstance(parts, list):
        yield from (part for part in parts if isinstance(part, list))
    elif kind == "GeometryCollection" and isinstance(geometry.get("geometries"), list):
        for inner in geometry["geometries"]:
            yield from _lines(inner)


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
        raise input_error(path, f"{place} is a {kind} without a list of its parts")
    if kind == "GeometryCollection":
        for part in parts:
            yield from _polygons(path, place, part)
        return
    for polygon in [parts] if kind == "Polygon" else parts:
        if not isinstance(polygon, list):
            raise input_error(path, f"{place} has a polygon that is not a list of rings")
        if polygon:
            yield tuple(ring(path, place, inner if isinstance(inner, list) else [None]) for inner in polygon)
