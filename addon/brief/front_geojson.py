"""Fronts and observed perimeters as GeoJSON lines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from firetwin_core.run import Run

from ..ellipsoid import metres_per_degree
from ..run import areas, fronts, times
from ..run.front import reach
from ..run.fronts import Front, Line
from ..run.observations import Perimeter


def feature_collection(found: list[Front], tolerance: float) -> dict[str, Any]:
    """Convert all fronts to GeoJSON (RFC 7946) with time (UTC) and burned area (m2)."""
    features = [
        _feature({"time": times.iso(front.utc), "area": round(front.area)}, front.lines, tolerance)
        for front in found
    ]
    return {"type": "FeatureCollection", "features": features}


def perimeter_collection(run: Run, perimeters: Sequence[Perimeter]) -> dict[str, Any]:
    """Convert observed perimeters, simplified by half a fuel cell, to GeoJSON with time (UTC) and file."""
    fire, middle = reach(run), 0.5 * float(run.longitude[0] + run.longitude[-1])
    tolerance = fronts.cell_tolerance(fire)
    features = []
    for perimeter in perimeters:
        rings = [np.asarray(ring, np.float64) for polygon in perimeter.polygons for ring in polygon]
        closed = [np.vstack([ring, ring[:1]]) for ring in rings]
        turned = [np.column_stack([areas.turned(ring[:, 0], middle), ring[:, 1]]) for ring in closed]
        lines = [fronts.simplify(ring, fronts.tolerances_per_degree(fire, tolerance)) for ring in turned]
        properties = {"time": times.iso(perimeter.time), "source": perimeter.source}
        features.append(_feature(properties, lines, tolerance))
    return {"type": "FeatureCollection", "features": features}


def _feature(properties: dict[str, Any], lines: list[Line], tolerance: float) -> dict[str, Any]:
    """Round lines to a step of at most a third of the tolerance (m)."""
    digits = int(np.ceil(-np.log10(tolerance / 3.0 / metres_per_degree(0.0)[0])))
    coordinates = [np.round(line, digits).tolist() for line in lines]
    geometry = {"type": "MultiLineString", "coordinates": coordinates}
    return {"type": "Feature", "properties": properties, "geometry": geometry}
