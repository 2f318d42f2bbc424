"""What a file of places holds: sources, types, stations, resources, availability and areas."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ORIGINS = ("fact", "exercise", "user")
"""A published fact with its source; invented for an exercise; or given by the user."""

MODES = ("attack", "structure", "drop", "line", "water", "lift", "command")
"""Operational modes: attack on the ground, protection of structures, drops from the air, building line,
supply of water, carrying people and loads, command and reconnaissance."""

STAFFING = ("career", "seasonal", "volunteer", "call-when-needed")
"""How the people of a resource are employed."""

STATUSES = ("available", "committed", "reserved", "unavailable")
"""Status of a resource in a window of time, in the words of the interagency resource ordering system IROC."""

AIR = ("airtanker", "helicopter")
"""Kinds that fly straight; all others follow roads."""

DETOUR = 1.4
"""Length of roads by straight distance, an assumption: there is no road network."""

EXERCISE = "Exercise: not operational advice"
"""What stands on everything that shows an exercise's places."""


@dataclass(frozen=True, slots=True)
class Source:
    """Where rows come from: name, licence, day of the data (ISO 8601), address, and hash of the file."""

    id: int
    name: str
    licence: str
    retrieved: str
    url: str = ""
    sha256: str = ""


@dataclass(frozen=True, slots=True)
class Type:
    """A type of resource by a typing standard, such as ``engine/3``; None where it has no such minimum.

    Attributes
    ----------
    tank_l
        Least water or retardant carried, l.
    payload_kg
        Least payload, kg.
    pump_l_min
        Least flow of the pump, l/min.
    people
        Least number of people.
    standard
        The standard, and the day when it was read.
    """

    code: str
    kind: str
    category: str
    type: str
    tank_l: float | None = None
    payload_kg: float | None = None
    pump_l_min: float | None = None
    people: int | None = None
    standard: str = ""


@dataclass(frozen=True, slots=True)
class Station:
    """A place that resources start from, in degrees north and east (WGS84).

    Attributes
    ----------
    kind
        What it is, such as ``fire station`` or ``exercise base``.
    source
        `Source.id`.
    source_id
        Its name or number in the source.
    origin
        One of `ORIGINS`.
    picture
        Name of a picture file; empty without one.
    """

    id: int
    name: str
    latitude: float
    longitude: float
    origin: str
    source: int
    kind: str = ""
    agency: str = ""
    address: str = ""
    source_id: str = ""
    picture: str = ""

    @property
    def title(self) -> str:
        """Its name; without one, its number: ``station 7``."""
        return self.name if self.name.strip() else f"station {self.id}"


@dataclass(frozen=True, slots=True)
class Resource:
    """What stands at a station. A row of several (`count`) is sent as a whole. None is not known.

    Attributes
    ----------
    station
        `Station.id`.
    type
        `Type.code`.
    origin
        One of `ORIGINS`.
    source
        `Source.id`.
    count
        Number of units.
    load_kg
        Water or retardant of one unit in a trip, kg.
    speed_km_h
        Mean speed on the way, km/h.
    mobilise_min
        Minutes from the order to the departure.
    radius_km
        Radius of its area of coverage, km.
    line_m_h
        Line that one unit builds, m/h.
    cost_mobilise, cost_hour, cost_day
        Cost of one unit: once, for an hour, for a day, in `currency`.
    mode
        One of `MODES`.
    staffing
        One of `STAFFING`; empty where it is not known.
    night
        Whether it works at night.
    """

    id: int
    station: int
    type: str
    name: str
    origin: str
    source: int
    count: int = 1
    load_kg: float | None = None
    speed_km_h: float | None = None
    mobilise_min: float | None = None
    radius_km: float | None = None
    line_m_h: float | None = None
    cost_mobilise: float | None = None
    cost_hour: float | None = None
    cost_day: float | None = None
    currency: str = ""
    mode: str = "attack"
    staffing: str = ""
    night: bool = False
    note: str = ""


@dataclass(frozen=True, slots=True)
class Availability:
    """Status of a resource from `begins` until before `ends`, UTC; `area` is where it may be sent."""

    resource: int
    begins: datetime
    ends: datetime
    status: str = "available"
    area: str = ""


@dataclass(frozen=True, slots=True)
class Area:
    """Area of coverage of a station: polygons as lists of rings (n, 2), degrees east and north."""

    id: int
    name: str
    kind: str
    station: int
    polygons: tuple[tuple[NDArray[np.float64], ...], ...]
