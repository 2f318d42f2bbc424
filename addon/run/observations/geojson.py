"""GeoJSON (RFC 7946): WGS84 degrees, longitude before latitude; or the reference system that a file names."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...errors import input_error
from .feature import Feature, Polygon, degrees, ring

SUFFIXES = (".geojson", ".json")


def parse(path: Path) -> Any:
    """Parse a JSON text as UTF-8, with or without a byte order mark.

    Raises
    ------
    InputError
        The file is not JSON.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8-sig"))
    except json.JSONDecodeError as error:
        raise input_error(
            path, f"not valid JSON: {error.msg}", line=error.lineno, column=error.colno
        ) from None
    except (UnicodeDecodeError, RecursionError) as error:
        raise input_error(path, f"not valid JSON: {error}") from None


def read(path: Path, system: str = "") -> list[Feature]:
    """Read the features of a FeatureCollection, a Feature or a bare geometry.

    Parameters
    ----------
    system
        Reference system of coordinates that are not in degrees, if the file names none.

    Raises
    ------
    InputError
        The file is not GeoJSON, or pyproj is needed and missing.
    """
    whole = parse(path)
    if not isinstance(whole, dict) or "type" not in whole:
        raise input_error(path, 'not a GeoJSON file: it has no "type"')
    system = _named_system(whole) or ("" if _is_in_degrees(whole) else system)
    if whole["type"] == "FeatureCollection":
        features = whole.get("features")
        if not isinstance(features, list):
            raise input_error(path, 'not GeoJSON: its "features" are not a list')
    else:
        features = [whole if whole["type"] == "Feature" else {"geometry": whole}]
    own = ("type", "name")  # of the collection, not of its features
    said = {
        key: item for key, item in whole.items() if isinstance(item, str | int | float) and key not in own
    }
    return [_feature(path, f"feature {i}", item, said, system) for i, item in enumerate(features, 1)]


def _named_system(whole: dict[str, Any]) -> str:
    """Return the reference system, which GeoJSON of before 2016 and of QGIS may name; else an empty text."""
    crs = whole.get("crs")
    properties = crs.get("properties") if isinstance(crs, dict) else None
    if not isinstance(properties, dict):
        return ""
    code = properties.get("code")
    return f"EPSG:{code}" if isinstance(code, int) else str(properties.get("name", ""))


def _is_in_degrees(whole: dict[str, Any]) -> bool:
    """Check whether the first position of a file can be in degrees."""
    stack: list[Any] = [whole]
    while stack:
        each = stack.pop()
        if isinstance(each, dict):
            names = ("coordinates", "geometries", "geometry", "features")
            stack += [each[name] for name in names if isinstance(each.get(name), dict | list)]
        elif len(each) > 1 and all(isinstance(value, int | float) for value in each[:2]):
            return abs(each[0]) <= 540.0 and abs(each[1]) <= 90.0
        else:
            stack += [item for item in reversed(each) if isinstance(item, dict | list)]
    return True


def _feature(path: Path, place: str, feature: Any, said: dict[str, Any], system: str) -> Feature:
    """Parse a feature; collection properties `said`, such as ForeFire's ``valid_at``, apply to it."""
    if not isinstance(feature, dict):
        raise input_error(path, f"{place} is not a table")
    properties = feature.get("properties")
    return Feature(
        tuple(_polygons(path, place, feature.get("geometry"), system)),
        said | (properties if isinstance(properties, dict) else {}),
        place,
        degrees(path, place, list(_points(feature.get("geometry"))), system),
        tuple(degrees(path, place, line, system) for line in _lines(feature.get("geometry"))),
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


def _polygons(path: Path, place: str, geometry: Any, system: str) -> Iterator[Polygon]:
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
            yield from _polygons(path, place, part, system)
        return
    for polygon in [parts] if kind == "Polygon" else parts:
        if not isinstance(polygon, list):
            raise input_error(path, f"{place} has a polygon that is not a list of rings")
        if polygon:
            yield tuple(
                ring(path, place, inner if isinstance(inner, list) else [None], system) for inner in polygon
            )
