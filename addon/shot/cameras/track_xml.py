"""GPX and KML tracks: readers for both, and a GPX writer.

The parser is expat. A file with a document type is refused, as its entities can grow without bound.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import NamedTuple
from xml.parsers import expat
from xml.sax.saxutils import escape

import numpy as np

from ...errors import input_error
from ...run import times
from .track_point import Point, moment, number

_GROUND = {"clampToGround", "relativeToGround", "clampToSeaFloor", "relativeToSeaFloor"}


class Element(NamedTuple):
    """XML element by its local name, with the local name of its parent, and its line in the file."""

    name: str
    parent: str
    line: int
    attributes: dict[str, str]
    text: str


def gpx(path: Path) -> Iterator[Point]:
    """Read the points of a GPX file's tracks in order; of its routes if it has no track."""
    elements = read_elements(path, {"trkpt", "rtept", "ele", "time"})
    wanted = "trkpt" if any(element.name == "trkpt" for element in elements) else "rtept"
    inside: dict[str, Element] = {}
    for element in elements:
        if element.name in ("ele", "time"):
            inside |= {element.name: element} if element.parent == wanted else {}
        elif element.name == wanted:
            latitude, longitude = (
                number(path, element.line, element.attributes.get(name), name) for name in ("lat", "lon")
            )
            ele, time = inside.get("ele"), inside.get("time")
            yield Point(
                element.line,
                latitude,
                longitude,
                number(path, ele.line, ele.text, "height <ele>") if ele else None,
                moment=moment(path, time.line, time.text) if time else None,
            )
            inside = {}


def kml(path: Path) -> Iterator[Point]:
    """Read the points of a KML file's tracks (gx:Track); of its lines if it has no track."""
    elements = read_elements(path, {"when", "coord", "Track", "altitudeMode", "coordinates", "LineString"})
    if any(element.name == "Track" for element in elements):
        yield from _tracks(path, elements)
    else:
        yield from _lines(path, elements)


def _tracks(path: Path, elements: list[Element]) -> Iterator[Point]:
    when: list[Element] = []
    coord: list[Element] = []
    mode = "clampToGround"
    for element in elements:
        if element.name == "Track":
            if when and len(when) != len(coord):
                reason = (
                    f"a track of {len(when)} times <when> and {len(coord)} places <gx:coord>; make them equal"
                )
                raise input_error(path, reason, line=element.line)
            for i, place in enumerate(coord):
                at = moment(path, when[i].line, when[i].text) if when else None
                yield _kml_point(path, place.line, place.text.split(), mode)._replace(moment=at)
            when, coord, mode = [], [], "clampToGround"
        elif element.parent == "Track":
            mode = element.text.strip() if element.name == "altitudeMode" else mode
            when += [element] if element.name == "when" else []
            coord += [element] if element.name == "coord" else []


def _lines(path: Path, elements: list[Element]) -> Iterator[Point]:
    places, mode = None, "clampToGround"
    for element in elements:
        if element.name == "LineString":
            if places is not None:
                for match in re.finditer(r"\S+", places.text):
                    line = places.line + places.text.count("\n", 0, match.start())
                    yield _kml_point(path, line, match[0].split(","), mode)
            places, mode = None, "clampToGround"
        elif element.parent == "LineString":
            mode = element.text.strip() if element.name == "altitudeMode" else mode
            places = element if element.name == "coordinates" else places


def _kml_point(path: Path, line: int, parts: list[str], mode: str) -> Point:
    """Parse longitude, latitude and optional height; `mode` is KML's altitude mode."""
    if len(parts) not in (2, 3):
        raise input_error(path, "a place is longitude, latitude and height, in this order", line=line)
    longitude, latitude = (number(path, line, text, "longitude or latitude") for text in parts[:2])
    height = number(path, line, parts[2], "height") if len(parts) == 3 else None
    if mode.startswith("clamp"):
        return Point(line, latitude, longitude, 0.0, over_ground=True)
    return Point(line, latitude, longitude, height, over_ground=mode in _GROUND)


def read_elements(path: Path, wanted: set[str], content: bytes | None = None) -> list[Element]:
    """Elements of these local names, in the order of their end tags: inner elements come first.

    `content` replaces the content of the file.

    Raises
    ------
    InputError
        The file is not XML, or has a document type.
    """
    parser = expat.ParserCreate()
    elements: list[Element] = []
    opened: list[tuple[str, int, dict[str, str], list[str]]] = []

    def start(name: str, attributes: dict[str, str]) -> None:
        opened.append((name.rpartition(":")[2], parser.CurrentLineNumber, attributes, []))

    def end(_: str) -> None:
        name, line, attributes, text = opened.pop()
        if name in wanted:
            elements.append(Element(name, opened[-1][0] if opened else "", line, attributes, "".join(text)))

    def text(words: str) -> None:
        if opened[-1][0] in wanted:
            opened[-1][3].append(words)

    def refuse(*_: object) -> None:
        reason = "has a document type (<!DOCTYPE), which no track needs and which may be an attack; remove it"
        raise input_error(path, reason, line=parser.CurrentLineNumber)

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = text, refuse
    try:
        parser.Parse(path.read_bytes() if content is None else content, True)
    except expat.ExpatError as error:
        reason = f"is not whole XML ({expat.ErrorString(error.code)}); export the track again"
        raise input_error(path, reason, line=error.lineno, column=error.offset + 1) from None
    except (LookupError, ValueError) as error:
        raise input_error(path, f"cannot be read as XML: {error}", line=1) from None
    return elements


def gpx_text(
    name: str, latitude: np.ndarray, longitude: np.ndarray, height: np.ndarray, moments: list[datetime]
) -> str:
    """Write a GPX 1.1 file with one track: (n,) degrees to 0.1 mm, m to 0.1 mm, times to a microsecond."""
    points = "\n".join(
        f'<trkpt lat="{y:.9f}" lon="{x:.9f}"><ele>{h:.4f}</ele><time>{when}</time></trkpt>'
        for y, x, h, when in zip(
            latitude, longitude, height, (times.iso(each, "auto") for each in moments), strict=True
        )
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<gpx version="1.1" creator="Firetwin" xmlns="http://www.topografix.com/GPX/1/1">\n'
        f"<trk><name>{escape(name)}</name><trkseg>\n{points}\n</trkseg></trk>\n</gpx>\n"
    )
