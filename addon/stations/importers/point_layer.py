"""Point layers of stations, as QGIS saves them: GeoPackage or GeoJSON with any usual column names."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np

from ... import foreign_database
from ...run.observations import geojson, geopackage
from ...run.observations.feature import Feature
from .. import import_rows
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch
from . import column_names, days, drafts

NAME, ORDER = "point layer", 60

_SQLITE = b"SQLite format 3\0"


def sniff(path: Path, head: bytes) -> bool:
    """Return True for a GeoPackage with features, or GeoJSON."""
    if not head.startswith(_SQLITE):
        start = head.lstrip(b"\xef\xbb\xbf \r\n")
        return start.startswith(b"{") and (b'"FeatureCollection"' in head or b'"Feature"' in head)
    try:
        with foreign_database.opened(path) as base:
            return "gpkg_geometry_columns" in base.tables()
    except sqlite3.DatabaseError:
        return False


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read all points; outlines count with the middle of their bounds. The origin is ``user``.

    Raises
    ------
    InputError
        No column has the name or the number of a station, or the reference system is unknown.
    """
    with path.open("rb") as file:
        binary = file.read(len(_SQLITE)) == _SQLITE
    features = (geopackage if binary else geojson).read(path, options.crs)
    columns = list(dict.fromkeys(str(name) for each in features for name in each.properties))
    columns = [name for name in columns if not (binary and name == "layer")]
    column_of = column_names.find_columns(path, columns, options.columns)
    column_names.check_needed(path, columns, column_of, position=False)
    batch = Batch(name=path.stem, dropped=import_rows.private_columns(columns))
    if binary:
        batch.retrieved = _last_change(path)
    for feature in features:
        draft = drafts.make_draft(path, batch, feature.properties.get, column_of, feature.place)
        x, y = _middle(feature)
        import_rows.add(batch, y, x, draft)
    used = {
        meaning: name
        for meaning, name in column_of.items()
        if meaning not in ("x", "y", "latitude", "longitude")
    }
    batch.notes += drafts.describe_columns(used)
    return batch


def _middle(feature: Feature) -> tuple[float | None, float | None]:
    corners = [ring for rings in feature.polygons for ring in rings]
    points = feature.points[:1] if len(feature.points) else np.concatenate(corners) if corners else None
    if points is None:
        return None, None
    x, y = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return float(x), float(y)


def _last_change(path: Path) -> str:
    """Return the day of the last change of the layers, as a GeoPackage stores it; empty if it has none."""
    with foreign_database.opened(path) as base:
        if "last_change" not in base.columns("gpkg_contents"):
            return ""
        kinds = base.rows("gpkg_contents", ["data_type", "last_change"])
        return max((days.parse_day(when) for kind, when in kinds if kind == "features"), default="")
