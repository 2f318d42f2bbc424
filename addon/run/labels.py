"""Labels: named places, built in for known fires or from a user's list."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

from firetwin_core.run import Run

from .. import files
from ..data import history
from ..errors import InputError, input_error, reading
from . import tables

_SHOWN = ("town", "valley", "summit", "lake")
_NAMES = {
    "name": {"name", "label", "title"},
    "latitude": {"latitude", "lat"},
    "longitude": {"longitude", "lon", "lng", "long"},
}
_COLUMNS = "name, latitude and longitude (degrees)"
_LONGEST = 60  # characters of a name


class Label(NamedTuple):
    """A place: its name, degrees north and east, and its kind, if known."""

    name: str
    latitude: float
    longitude: float
    kind: str = ""


def known(run: Run) -> list[Label]:
    """Return the built-in labels of a run's fire: towns, lakes and summits with published positions."""
    if not run.event or run.event not in history.events():
        return []
    places = history.load(run.event).places
    return [
        Label(place.name, place.latitude, place.longitude, place.kind)
        for place in places
        if place.kind in _SHOWN and not place.approximate
    ]


def find(run: Run, path: Path | None) -> list[Label]:
    """Read the labels of a user's list, or return the built-in ones of a run's fire without a list."""
    return read(path) if path else known(run)


def read(path: Path) -> list[Label]:
    """Read labels from a GeoJSON file's points, or a CSV file with columns name, latitude and longitude.

    Raises
    ------
    InputError
        The file cannot be read or has another format.
    """
    if path.exists() and not path.is_file():  # opening a pipe would block
        raise input_error(path, "is not a file; name a CSV or GeoJSON")
    with reading(path):
        files.check_text_size(path)
        text = path.read_text(encoding="utf-8-sig")
        return _geojson(path, text) if text.lstrip().startswith("{") else _csv(path, text)


def _csv(path: Path, text: str) -> list[Label]:
    rows = tables.rows(path, iter(text.splitlines()), _NAMES, _NAMES, _COLUMNS)
    return [_label(path, line, **value) for line, value in rows]


def _geojson(path: Path, text: str) -> list[Label]:
    try:
        features = json.loads(text)["features"]
    except json.JSONDecodeError as error:
        reason = f"not a JSON file: {error.msg}"
        raise input_error(path, reason, line=error.lineno, column=error.colno) from None
    except (KeyError, TypeError, ValueError, RecursionError):
        raise input_error(path, "not a GeoJSON FeatureCollection") from None
    labels = []
    for number, feature in enumerate(features if isinstance(features, list) else [], 1):
        try:
            if feature["geometry"]["type"] != "Point":
                continue
            longitude, latitude = feature["geometry"]["coordinates"][:2]
            name = feature["properties"]["name"]
        except (KeyError, TypeError, ValueError, IndexError):
            reason = f'feature {number} has no name or no coordinates; give it a property "name" and a Point'
            raise input_error(path, reason) from None
        try:
            labels.append(_label(path, 0, name, latitude, longitude))
        except InputError as error:
            raise input_error(path, f"feature {number}: {error.reason}") from None
    return labels


def _label(path: Path, line: int, name: Any, latitude: Any, longitude: Any) -> Label:
    name = " ".join(str(name).split())
    if not 0 < len(name) <= _LONGEST:
        raise input_error(path, f"a name has 1 to {_LONGEST} letters, not {len(name)}", line=line)
    degrees: list[float] = []
    for what, value, most in (("latitude", latitude, 90.0), ("longitude", longitude, 180.0)):
        try:
            degrees.append(float(value))
        except (TypeError, ValueError, OverflowError):
            raise input_error(path, f"{what} is {value!r}, not a number of degrees", line=line) from None
        if not abs(degrees[-1]) <= most:
            raise input_error(
                path, f"{what} is {degrees[-1]:g}; it goes from {-most:g} to {most:g}", line=line
            )
    return Label(name, degrees[0], degrees[1])
