"""Fire stations of OpenStreetMap: JSON of the Overpass API (``out center``), or GeoJSON with ``@id``.

Tags amenity=fire_station, name, operator, ref, addr:*. Telephones and contacts are not read. The data are
under the Open Database License: publications must show "(c) OpenStreetMap contributors".
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import input_error
from ...run.observations import geojson
from ...run.observations.feature import finite
from .. import import_rows
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch, Draft

NAME, ORDER = "OpenStreetMap, (c) OpenStreetMap contributors", 40
LICENCE = "ODbL 1.0"
URL = "https://www.openstreetmap.org/copyright"

_OTHER = "not tagged amenity=fire_station"
_AMBULANCE = ("ambulance_station",)


def sniff(path: Path, head: bytes) -> bool:
    """Return True for elements of Overpass, or features with ``@id``."""
    if not head.lstrip(b"\xef\xbb\xbf \r\n").startswith(b"{"):
        return False
    overpass = b'"elements"' in head and (b'"osm3s"' in head or b'"tags"' in head)
    return overpass or b'"@id"' in head


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read all fire stations."""
    batch, whole = Batch(name=NAME, licence=LICENCE, url=URL), geojson.parse(path)
    if "elements" in whole:
        _read_elements(path, whole, batch)
    else:
        _read_features(path, batch, options.crs)
    return batch


def _read_elements(path: Path, whole: Mapping[str, Any], batch: Batch) -> None:
    elements = whole["elements"]
    if not isinstance(elements, list):
        raise input_error(path, 'not an Overpass response: "elements" is not a list')
    about = whole.get("osm3s")
    if isinstance(about, dict):
        batch.retrieved = str(about.get("timestamp_osm_base", ""))[:10]
    for number, element in enumerate(elements, 1):
        if not isinstance(element, dict):
            raise input_error(path, f"element {number} is not an object")
        tags = element.get("tags")
        if not isinstance(tags, dict):
            continue  # a node of a way
        at = element if "lat" in element else _centre(element)
        identity = f"{element.get('type')}/{element.get('id')}"
        _add(batch, tags, at.get("lat"), at.get("lon"), identity, f"element {number}")


def _centre(element: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the centre of a way or relation (``out center``), or the middle of its ``bounds``."""
    centre, bounds = element.get("center"), element.get("bounds")
    if isinstance(centre, dict):
        return centre
    if not isinstance(bounds, dict):
        return {}
    middles = ([finite(bounds.get(f"{end}{axis}")) for end in ("min", "max")] for axis in ("lat", "lon"))
    return {
        name: None if low is None or high is None else 0.5 * (low + high)
        for name, (low, high) in zip(("lat", "lon"), middles, strict=True)
    }


def _read_features(path: Path, batch: Batch, crs: str) -> None:
    for feature in geojson.read(path, crs):
        corners = [ring for rings in feature.polygons for ring in rings] or [feature.points]
        points = np.concatenate(corners)
        x, y = 0.5 * (points.min(axis=0) + points.max(axis=0)) if len(points) else (None, None)
        identity = str(feature.properties.get("@id", ""))
        _add(batch, feature.properties, y, x, identity, feature.place)


def _add(
    batch: Batch, tags: Mapping[str, Any], latitude: Any, longitude: Any, identity: str, place: str
) -> None:
    batch.dropped = sorted({*batch.dropped, *import_rows.private_columns(map(str, tags))})
    if tags.get("amenity") != "fire_station":
        medical = tags.get("emergency") in _AMBULANCE or tags.get("amenity") in _AMBULANCE
        batch.rejected.add(import_rows.EMS if medical else _OTHER, place)
        return
    name, number = (_text(tags, key) for key in ("name", "ref"))
    street = " ".join(filter(None, (_text(tags, "addr:housenumber"), _text(tags, "addr:street"))))
    address = [street, *(_text(tags, f"addr:{key}") for key in ("city", "state", "postcode"))]
    draft = Draft(
        name or (f"Fire station {number}" if number else ""), 0.0, 0.0,
        agency=_text(tags, "operator"), address=", ".join(each for each in address if each),
        source_id=identity, place=place,
    )  # fmt: skip
    import_rows.add(batch, latitude, longitude, draft)


def _text(tags: Mapping[str, Any], key: str) -> str:
    return str(tags.get(key) or "").strip()
