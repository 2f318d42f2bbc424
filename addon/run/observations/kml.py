"""KML and KMZ: placemarks with polygons or points, their folders, and TimeStamp or the end of TimeSpan."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

from ... import files, limits, unpacking
from ...errors import InputError, input_error
from . import xml_tree
from .feature import Feature, Polygon, Ring, degrees, ring

SUFFIXES = (".kml", ".kmz")


def read(path: Path) -> list[Feature]:
    """Read all placemarks.

    Raises
    ------
    InputError
        The file is not KML.
    """
    text = unpack_kmz(path) if path.suffix.lower() == ".kmz" else path.read_bytes()
    return list(_placemarks(path, xml_tree.parse(text, path), {}))


def unpack_kmz(path: Path) -> bytes:
    """Read the first KML of a KMZ.

    Raises
    ------
    InputError
        The file is not a KMZ, or its KML is too large.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            inside = [item for item in archive.infolist() if item.filename.lower().endswith(".kml")]
            if not inside:
                raise input_error(path, "contains no .kml file")
            text = unpacking.read_member(path, archive, inside[0], limits.TEXT_BYTES)
            files.check_values(path, [text])
            return text
    except InputError:
        raise
    except unpacking.ERRORS as error:
        raise input_error(path, f"not a KMZ file: {str(error)[:1].lower()}{str(error)[1:]}") from None


def _placemarks(path: Path, folder: Element, inherited: dict[str, str]) -> Iterator[Feature]:
    """Yield placemarks of a folder and its subfolders; a folder's time applies to those without one."""
    inherited_values = inherited | _time(folder)
    if _tag(folder) == "Folder" and (called := _name(folder)):
        inherited_values["folder"] = (
            f"{called}/{inherited_values['folder']}" if "folder" in inherited_values else called
        )
    for child in folder:
        if _tag(child) == "Placemark":
            name = _name(child)
            place = f'placemark "{name}"' if name else "a placemark"
            said = inherited_values | ({"name": name} if name else {}) | _time(child) | _data(child)
            yield Feature(tuple(_polygons(path, place, child)), said, place, _points(path, place, child))
        elif _tag(child) in ("Document", "Folder"):
            yield from _placemarks(path, child, inherited_values)


def _name(element: Element) -> str:
    return next((child.text.strip() for child in element if _tag(child) == "name" and child.text), "")


def _points(path: Path, place: str, placemark: Element) -> Ring:
    texts = (
        each.text or ""
        for point in placemark.iter()
        if _tag(point) == "Point"
        for each in point
        if _tag(each) == "coordinates"
    )
    return degrees(path, place, [text.strip().split(",") for text in texts])


def _time(element: Element) -> dict[str, str]:
    """Return `when` of a TimeStamp, or the end of a TimeSpan, when all has burned, otherwise its begin.

    The begin is also `begin`.
    """
    for child in element:
        if _tag(child) in ("TimeStamp", "TimeSpan"):
            times = {_tag(each): (each.text or "").strip() for each in child}
            text = times.get("when") or times.get("end") or times.get("begin")
            begin = {"begin": times["begin"]} if times.get("begin") else {}
            return ({"when": text} if text else {}) | begin
    return {}


def _data(placemark: Element) -> dict[str, str]:
    properties = {}
    for element in placemark.iter():
        if _tag(element) == "SimpleData":
            properties[element.get("name", "")] = (element.text or "").strip()
        elif _tag(element) == "Data":
            properties[element.get("name", "")] = "".join(
                v.text or "" for v in element if _tag(v) == "value"
            ).strip()
    return properties


def _polygons(path: Path, place: str, placemark: Element) -> Iterator[Polygon]:
    for polygon in placemark.iter():
        if _tag(polygon) == "Polygon":
            rings = [_ring(path, place, text) for text in _rings(polygon, "outerBoundaryIs")]
            if len(rings) != 1:
                raise input_error(path, f"{place} has a polygon with {len(rings)} outer rings")
            yield (*rings, *(_ring(path, place, text) for text in _rings(polygon, "innerBoundaryIs")))


def _rings(polygon: Element, which: str) -> Iterator[str]:
    for boundary in polygon:
        if _tag(boundary) == which:
            yield from (each.text or "" for each in boundary.iter() if _tag(each) == "coordinates")


def _ring(path: Path, place: str, text: str) -> Ring:
    return ring(path, place, (point.split(",") for point in text.split()))


def _tag(element: Element) -> str:
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""
