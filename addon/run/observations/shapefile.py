"""Shapefiles: polygons or points (.shp), dates (.dbf) and reference system (.prj)."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ... import extras
from ...errors import input_error
from ...files import read_text
from ...limits import SETTINGS_BYTES
from .feature import Feature, Polygon, degrees, ring
from .projection import to_degrees

SUFFIXES = (".shp",)


def read(path: Path) -> list[Feature]:
    """Read all shapes.

    Raises
    ------
    InputError
        There is no .prj, or pyshp is missing.
    """
    path.stat()
    try:
        import shapefile
    except ModuleNotFoundError:
        reason = f"shapefiles need pyshp: {extras.install('score')}; or save it as GeoJSON"
        raise input_error(path, reason) from None
    try:
        system = read_text(path.with_suffix(".prj"), errors="replace", most=SETTINGS_BYTES).strip()
    except OSError:
        reason = "has no .prj, which gives its reference system; add it"
        raise input_error(path, reason) from None
    with warnings.catch_warnings(), shapefile.Reader(str(path)) as reader:
        warnings.simplefilter("ignore")  # about damage, which raises an error later
        return [_feature(path, system, i, each) for i, each in enumerate(reader.iterShapeRecords(), 1)]


def _feature(path: Path, system: str, number: int, record: Any) -> Feature:
    place = f"shape {number}"
    shape = record.shape.__geo_interface__ if record.shape.shapeTypeName.startswith("POLYGON") else None
    polygons: list[Polygon] = []
    if shape and shape["coordinates"]:
        parts = [shape["coordinates"]] if shape["type"] == "Polygon" else shape["coordinates"]
        for rings in parts:
            flat = [np.array([point[:2] for point in each], np.float64) for each in rings]
            polygons.append(tuple(ring(path, place, to_degrees(path, system, each)) for each in flat))
    points = np.empty((0, 2))
    if record.shape.shapeTypeName.startswith(("POINT", "MULTIPOINT")):
        single = np.array([point[:2] for point in record.shape.points], np.float64).reshape(-1, 2)
        points = degrees(path, place, to_degrees(path, system, single))
    return Feature(tuple(polygons), record.record.as_dict() if record.record else {}, place, points)
