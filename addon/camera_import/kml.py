"""Tours of KML and KMZ (gx:Tour): flights to a Camera or a LookAt, and waits."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .. import files
from ..errors import input_error, reading
from ..run.observations.kml import unpack_kmz
from ..shot.cameras import rotation as turning
from ..shot.cameras.track_point import number
from ..shot.cameras.track_xml import Element, read_elements
from ..shot.terrain.terrain import Terrain
from .move import Move

_VIEW = ("longitude", "latitude", "altitude", "heading", "tilt", "roll", "range", "altitudeMode", "horizFov")
_WANTED = {*_VIEW, "Tour", "FlyTo", "Wait", "Camera", "LookAt", "duration", "name"}
_FIELD_OF_VIEW = 60.0  # degrees, horizontal, of Google Earth
_WIDEST = 170.0  # degrees


@dataclass
class _Tour:
    """Tour while it is read: views, and their times in s."""

    name: str = ""
    views: list[tuple[Element, dict[str, Element]]] = field(default_factory=list)
    times: list[float] = field(default_factory=list)


def tours(path: Path, ground: Terrain, geoid: float) -> list[Move]:
    """Read the tours of a KML or KMZ; empty if it has none.

    Parameters
    ----------
    geoid
        Height to add to heights above sea level, m.

    Raises
    ------
    InputError
        Names the file, the line and what to do.
    """
    with reading(path):
        if path.suffix.lower() == ".kmz":
            found = read_elements(path, _WANTED, unpack_kmz(path))
        else:
            files.check_text_size(path)
            found = read_elements(path, _WANTED)
    return [_move(path, tour, ground, geoid) for tour in _parse(path, found) if tour.views]


def _parse(path: Path, elements: list[Element]) -> list[_Tour]:
    """Group the elements of tours; inner elements come first."""
    tours, tour, time = [], _Tour(), 0.0
    inside: dict[str, Element] = {}
    view: tuple[Element, dict[str, Element]] | None = None
    lasts = 0.0
    for element in elements:
        if element.name in ("Camera", "LookAt"):
            view, inside = (element, inside) if element.parent == "FlyTo" else None, {}
        elif element.name == "duration" and element.parent in ("FlyTo", "Wait"):
            lasts = max(number(path, element.line, element.text, "duration"), 0.0)
        elif element.name in ("FlyTo", "Wait"):
            time += lasts if tour.views else 0.0  # a tour begins at its first view
            if element.name == "Wait":
                view = tour.views[-1] if tour.views else None
            if view and (not tour.times or time > tour.times[-1]):
                tour.views.append(view)
                tour.times.append(time)
            view, lasts = None, 0.0
        elif element.name == "Tour":
            tours.append(tour)
            tour, time = _Tour(), 0.0
        elif element.name == "name":
            tour.name = element.text.strip() if element.parent == "Tour" else tour.name
        elif element.parent in ("Camera", "LookAt"):
            inside[element.name] = element
    return tours


def _move(path: Path, tour: _Tour, ground: Terrain, geoid: float) -> Move:
    made = [_pose(path, view, values, ground, geoid) for view, values in tour.views]
    place, rotation, half = (np.array(part, np.float64) for part in zip(*made, strict=True))
    return Move(tour.name or path.stem, np.array(tour.times), place, rotation, half)


def _pose(
    path: Path, view: Element, values: dict[str, Element], ground: Terrain, geoid: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Compute position (3,), rotation (3, 3) and tangent of half the angle of view of a view."""

    def value(name: str, default: float | None = None) -> float:
        if name in values:
            return number(path, values[name].line, values[name].text, name)
        if default is None:
            raise input_error(path, f"a view without <{name}>; export the tour again", line=view.line)
        return default

    latitude, longitude = value("latitude"), value("longitude")
    if not (abs(latitude) <= 90.0 and abs(longitude) <= 180.0):
        raise input_error(
            path, f"{latitude:g}, {longitude:g} is not a latitude and longitude", line=view.line
        )
    mode = values["altitudeMode"].text.strip() if "altitudeMode" in values else "clampToGround"
    (place,) = ground.frame.forward([latitude], [longitude], [value("altitude", 0.0) + geoid])
    if mode != "absolute":
        above = 0.0 if mode.startswith("clamp") else value("altitude", 0.0)
        place[2] = ground.up(place[:1], place[1:2])[0] + above
    tilt = 90.0 - value("tilt", 0.0)
    rotation = turning.turned(ground.frame, place, value("heading", 0.0), tilt, value("roll", 0.0))
    if view.name == "LookAt":
        place = place + value("range") * rotation[:, 2]
    angle = min(max(value("horizFov", _FIELD_OF_VIEW), 0.1), _WIDEST)
    return place, rotation, float(np.tan(np.radians(0.5 * angle)))
