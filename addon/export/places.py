"""Named places of an export: stations, labels, ignition, and the divisions of an allocation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..errors import input_error
from ..run.observations import Detections, Feature, features
from ..shot.shot import Shot
from ..shot.stations import labels, station_signs

STATION, LABEL, IGNITION = "Station", "Named place", "Fire Origin"
"""Names of the places' symbols in the map standard of the NWCG."""


@dataclass(frozen=True)
class Place:
    """A named place.

    Attributes
    ----------
    symbol
        Name of its symbol (see `imaging.map_symbols`).
    latitude, longitude
        Degrees.
    lines
        Text below the name.
    exercise
        True if a part of the text was invented for an exercise.
    """

    name: str
    symbol: str
    kind: str
    latitude: float
    longitude: float
    lines: tuple[str, ...] = ()
    exercise: bool = False


def find(shot: Shot) -> list[Place]:
    """Find the stations and labels that the scene file enables, and the ignition.

    Raises
    ------
    InputError
        A file of the scene cannot be read.
    """
    return [*_stations(shot), *_labels(shot), *_ignition(shot)]


def divisions(shot: Shot) -> list[Feature]:
    """Find the control lines, division breaks and resources of `firetwin allocate` in the routes' file.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    settings = shot.settings.stations
    if not settings.enabled or settings.routes_file is None:
        return []
    return _divisions(settings.routes_file)


def _divisions(path: Path) -> list[Feature]:
    found = features(path)
    if isinstance(found, Detections):
        raise input_error(path, "has satellite detections; name a file of lines or polygons")
    kinds = ("control_line", "division_break", "resource")
    return [each for each in found if each.properties.get("kind") in kinds]


def _stations(shot: Shot) -> Iterator[Place]:
    for sign in station_signs.make_signs(shot):
        where = sign.latitude, sign.longitude
        yield Place(sign.name, STATION, sign.kind, *where, lines=sign.lines, exercise=sign.exercise)


def _labels(shot: Shot) -> Iterator[Place]:
    found = labels.find(shot)
    if not found.names:
        return
    latitude, longitude, _ = shot.local_frame.reverse(found.position)
    for name, kind, north, east in zip(found.names, found.kinds, latitude, longitude, strict=True):
        yield Place(name, LABEL, kind, float(north), float(east))


def _ignition(shot: Shot) -> Iterator[Place]:
    began = station_signs.ignition_point(shot)
    if began is not None:
        yield Place("Ignition", IGNITION, "ignition", *began)
