"""Records of a station file: sources, types, stations, resources, availability and areas."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ORIGINS = ("fact", "exercise", "user")
"""Published fact with its source; invented for an exercise; entered by the user."""

MODES = ("attack", "structure", "drop", "line", "water", "lift", "command")
"""Operational modes: ground attack, structure protection, air drop, line construction, water supply,
transport of people and loads, command and reconnaissance."""

STAFFING = ("career", "seasonal", "volunteer", "call-when-needed")
"""Employment of the people of a resource."""

STATUSES = ("available", "committed", "reserved", "unavailable")
"""Status of a resource in a time window, in terms of the interagency resource ordering system IROC."""

AIR = ("airtanker", "helicopter")
"""Kinds that fly straight; all other kinds follow roads."""

DETOUR = 1.4
"""Ratio of road length to straight distance, an assumption, as the program has no road network."""

EXERCISE = "Exercise: not operational advice"
"""Label of everything that shows an exercise."""


@dataclass(frozen=True, slots=True)
class Source:
    """Source of rows: name, licence, date of the data (ISO 8601), address, and hash of the file."""

    id: int
    name: str
    licence: str
    retrieved: str
    url: str = ""
    sha256: str = ""


@dataclass(frozen=True, slots=True)
class Type:
    """Type of resource in a typing standard, such as ``engine/3``; None: no such minimum.

    Attributes
    ----------
    tank_l
        Minimum water or retardant carried, l.
    payload_kg
        Minimum payload, kg.
    pump_l_min
        Minimum flow of the pump, l/min.
    people
        Minimum number of people.
    standard
        The standard, and the date of the version.
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
    """Station: starting point of resources, in degrees north and east (WGS84).

    Attributes
    ----------
    kind
        Kind of station, such as ``fire station`` or ``exercise base``.
    source
        `Source.id`.
    source_id
        Name or number in the source.
    origin
        One of `ORIGINS`.
    picture
        Name of a picture file, or empty.
    staffing
        Employment of its people as the source describes it, or empty.
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
    staffing: str = ""

    @property
    def title(self) -> str:
        """Name, or number if the name is empty: ``station 7``."""
        return self.name if self.name.strip() else f"station {self.id}"


@dataclass(frozen=True, slots=True)
class Resource:
    """Resource of a station. The `count` units of a row are sent together. None: unknown.

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
        Water or retardant that one unit carries in a trip, kg.
    speed_km_h
        Mean travel speed, km/h.
    mobilise_min
                Getaway time: minutes from the order to the departure.
    radius_km
        Radius of its response area, km.
    line_m_h
        Line production rate of one unit, m/h.
    cost_mobilise, cost_hour, cost_day
        Cost of one unit: once, for an hour, for a day, in `currency`.
    mode
        One of `MODES`.
    staffing
        One of `STAFFING`; empty: unknown.
    night
        True if it works at night.
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
    """Status of a resource from `begins` until before `ends`, UTC; `area` limits its use."""

    resource: int
    begins: datetime
    ends: datetime
    status: str = "available"
    area: str = ""


@dataclass(frozen=True, slots=True)
class Area:
    """Response area of a station: polygons as lists of rings (n, 2), degrees east and north."""

    id: int
    name: str
    kind: str
    station: int
    polygons: tuple[tuple[NDArray[np.float64], ...], ...]
