"""Stations and resources of the page, read from a GeoPackage, and what the page needs to know of them."""

from __future__ import annotations

import contextlib
import math
import sqlite3
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from ..errors import input_error
from ..run.observations import geopackage

ORIGINS = ("fact", "exercise", "user")
"""Whether a row is a published fact, made up for an exercise, or given by the user."""
EXERCISE = "Exercise: not operational advice"
_NO_PLACES = "is no file of stations; name a GeoPackage with tables station, resource, type and source"


@dataclass(frozen=True)
class Source:
    """Where rows come from: name, licence, date of the data (empty: not known) and address."""

    name: str
    licence: str = ""
    retrieved: str = ""
    url: str = ""


@dataclass(frozen=True)
class Resource:
    """An engine, crew or aircraft of a station.

    Attributes
    ----------
    facts
        Label and value of what is known of it, in the page's units.
    availability
        Begin and end (UTC, ISO 8601, may be empty), status and area.
    """

    name: str
    type: str
    count: int
    origin: str
    source: str = ""
    note: str = ""
    facts: tuple[tuple[str, str], ...] = ()
    availability: tuple[tuple[str, str, str, str], ...] = ()


@dataclass(frozen=True)
class Station:
    """A station at a position in degrees, with its resources."""

    name: str
    agency: str
    kind: str
    address: str
    latitude: float
    longitude: float
    origin: str
    source: str = ""
    resources: tuple[Resource, ...] = field(default=())


class Places(Protocol):
    """What the page reads of a collection of stations."""

    @property
    def stations(self) -> Sequence[Station]:
        """Stations by name."""

    @property
    def sources(self) -> Sequence[Source]:
        """Sources of all rows."""


@dataclass(frozen=True)
class FilePlaces:
    """Stations and sources of a file."""

    stations: tuple[Station, ...]
    sources: tuple[Source, ...]


def is_exercise(places: Places) -> bool:
    """Whether any row is made up for an exercise."""
    return any(
        "exercise" in (station.origin, *(resource.origin for resource in station.resources))
        for station in places.stations
    )


def read(path: Path) -> FilePlaces:
    """Read a GeoPackage of stations and resources.

    Raises
    ------
    InputError
        The file is something else, or a row lacks its name, position or origin.
    """
    path.stat()  # raises for a missing file; SQLite would create one
    try:
        with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as base:
            base.row_factory = sqlite3.Row
            return _read(path, base)
    except sqlite3.Error as error:
        raise input_error(path, 0, 0, f"{_NO_PLACES} ({error})") from None


def _read(path: Path, base: sqlite3.Connection) -> FilePlaces:
    sources = {row["id"]: _source(row) for row in base.execute("SELECT * FROM source ORDER BY id")}
    names = {key: source.name for key, source in sources.items()}
    times: dict[int, list[tuple[str, str, str, str]]] = {}
    for row in base.execute("SELECT * FROM availability ORDER BY resource, begins"):
        period = tuple(_text(row[key]) for key in ("begins", "ends", "status", "area"))
        times.setdefault(row["resource"], []).append(period)  # type: ignore[arg-type]
    resources: dict[int, list[Resource]] = {}
    for row in base.execute(_RESOURCES):
        resource = _resource(path, row, names, times.get(row["id"], []))
        resources.setdefault(row["station"], []).append(resource)
    stations = tuple(
        _station(path, row, names, resources.get(row["fid"], []))
        for row in base.execute("SELECT * FROM station ORDER BY name, fid")
    )
    return FilePlaces(stations, tuple(sources.values()))


_RESOURCES = (
    "SELECT resource.*, type.kind AS type_kind, type.category AS type_category, type.type AS type_number, "
    "type.tank_l AS tank_l, type.pump_l_min AS pump_l_min, type.people AS people, type.standard AS standard "
    "FROM resource LEFT JOIN type ON type.code = resource.type ORDER BY resource.station, resource.id"
)


def _source(row: sqlite3.Row) -> Source:
    return Source(*(_text(row[key]) for key in ("name", "licence", "retrieved", "url")))


def _station(path: Path, row: sqlite3.Row, names: dict[int, str], resources: list[Resource]) -> Station:
    where = f"row {row['fid']} of station"
    latitude, longitude = _position(path, where, row)
    return Station(
        name=_text(row["name"]) or f"station {row['fid']}",
        agency=_text(row["agency"]),
        kind=_text(row["kind"]),
        address=_text(row["address"]),
        latitude=latitude,
        longitude=longitude,
        origin=_origin(path, where, row),
        source=names.get(row["source"], ""),
        resources=tuple(resources),
    )


def _position(path: Path, where: str, row: sqlite3.Row) -> tuple[float, float]:
    """Latitude and longitude: of columns lat and lon, else of the point."""
    if not {"lat", "lon"} <= set(row.keys()):
        with contextlib.suppress(struct.error, ValueError, IndexError, TypeError):
            points = [points for kind, points in geopackage.parts_of(row["geom"]) if kind == "point"]
            if len(points) == 1:
                longitude, latitude = (float(value) for value in points[0])
                return latitude, longitude
        raise input_error(path, 0, 0, f"{where} has no point as its geometry")
    degrees = []
    for key, most in (("lat", 90.0), ("lon", 360.0)):
        value = row[key]
        if not isinstance(value, int | float) or not math.isfinite(value) or abs(value) > most:
            raise input_error(path, 0, 0, f"{where} has {key} = {value!r}; it is a number of degrees")
        degrees.append(float(value))
    return degrees[0], degrees[1]


def _resource(
    path: Path, row: sqlite3.Row, names: dict[int, str], times: list[tuple[str, str, str, str]]
) -> Resource:
    where = f"row {row['id']} of resource"
    words = (_text(row[key]) for key in ("type_kind", "type_category", "type_number"))
    kind = " ".join(dict.fromkeys(filter(None, words)))
    return Resource(
        _text(row["name"]),
        kind or _text(row["type"]),
        int(row["count"] or 1),
        _origin(path, where, row),
        names.get(row["source"], ""),
        _text(row["note"]),
        tuple(_facts(row)),
        tuple(times),
    )


_FACTS = {
    "tank_l": ("tank", "l"),
    "load_kg": ("load", "kg"),
    "pump_l_min": ("pump", "l/min"),
    "people": ("people", ""),
    "line_m_h": ("line", "m/h"),
    "speed_km_h": ("speed", "km/h"),
    "mobilise_min": ("mobilises in", "min"),
    "radius_km": ("radius", "km"),
}
"""Label and unit of columns with numbers."""
_COSTS = {"cost_mobilise": "to mobilise", "cost_hour": "per hour", "cost_day": "per day"}


def _facts(row: sqlite3.Row) -> list[tuple[str, str]]:
    known = {key: row[key] for key in row.keys() if row[key] not in (None, "")}  # noqa: SIM118
    found = [
        (label, f"{_number(known[key])} {unit}".strip())
        for key, (label, unit) in _FACTS.items()
        if key in known
    ]
    for key, what in _COSTS.items():
        if known.get(key):
            found.append(("cost", " ".join((f"{known[key]:,.0f}", _text(known.get("currency")), what))))
    found += [(key, _text(known[key])) for key in ("mode", "staffing") if key in known]
    found += [("night", "works" if known["night"] else "does not work")] if "night" in known else []
    return found


def _number(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def _origin(path: Path, where: str, row: sqlite3.Row) -> str:
    if row["origin"] not in ORIGINS:
        words = ", ".join(ORIGINS)
        raise input_error(path, 0, 0, f"{where} has origin = {row['origin']!r}; it is one of: {words}")
    return row["origin"]


def _text(value: Any) -> str:
    return "" if value is None else str(value)
