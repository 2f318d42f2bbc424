"""StationFile in memory: records of a file, and the arrays that searches use."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .categorical import Categorical
from .records import Area, Availability, Resource, Source, Station, Type

Array = NDArray[np.float64]

WATER_KG_L = 1.0  # density of water, kg/l


@dataclass(frozen=True)
class Columns:
    """Values of all resources (n,), in the order of `StationFile.resources`; NaN: unknown.

    Attributes
    ----------
    station
        Index into `StationFile.stations`.
    latitude, longitude
        Position of the station, degrees.
    load_kg
        Load of one unit; if unknown, the minimum tank of its type, full of water.
    """

    id: NDArray[np.int64]
    station: NDArray[np.int64]
    latitude: Array
    longitude: Array
    count: NDArray[np.int64]
    load_kg: Array
    speed_km_h: Array
    mobilise_min: Array
    radius_km: Array
    line_m_h: Array
    cost_mobilise: Array
    cost_hour: Array
    cost_day: Array
    night: NDArray[np.bool_]


@dataclass(frozen=True)
class Windows:
    """Windows of availability (m,), by start time.

    Attributes
    ----------
    row
        Index into `StationFile.resources`.
    number
        Index into `StationFile.availability`.
    begins, ends
        Seconds since 1970.
    available
        True if the status is ``available``.
    """

    row: NDArray[np.int64]
    number: NDArray[np.int64]
    begins: Array
    ends: Array
    available: NDArray[np.bool_]


@dataclass(frozen=True)
class Codes:
    """Categorical columns of all resources, in the order of `StationFile.resources`; `type` without kind."""

    kind: Categorical
    type: Categorical
    mode: Categorical
    staffing: Categorical
    currency: Categorical


@dataclass(frozen=True)
class StationFile:
    """Content of one station file, or of several merged ones."""

    stations: tuple[Station, ...] = ()
    resources: tuple[Resource, ...] = ()
    availability: tuple[Availability, ...] = ()
    sources: tuple[Source, ...] = ()
    types: tuple[Type, ...] = ()
    areas: tuple[Area, ...] = ()

    @cached_property
    def source_of(self) -> dict[int, Source]:
        """Sources by number."""
        return {source.id: source for source in self.sources}

    @cached_property
    def type_of(self) -> dict[str, Type]:
        """Types by code."""
        return {each.code: each for each in self.types}

    @cached_property
    def station_row(self) -> dict[int, int]:
        """Index into `stations` by the number of a station."""
        return {station.id: row for row, station in enumerate(self.stations)}

    @cached_property
    def resources_of(self) -> dict[int, list[Resource]]:
        """Resources of each station by its number; an empty list for a station without resources."""
        found: dict[int, list[Resource]] = {station.id: [] for station in self.stations}
        for each in self.resources:
            found[each.station].append(each)
        return found

    @cached_property
    def windows_of(self) -> dict[int, list[Availability]]:
        """Windows of availability of each resource by its number, by start time."""
        found: dict[int, list[Availability]] = {each.id: [] for each in self.resources}
        for window in sorted(self.availability, key=lambda each: each.begins):
            found[window.resource].append(window)
        return found

    @property
    def exercise(self) -> bool:
        """True if a row was invented for an exercise; every view of the file is labelled then."""
        return any(each.origin == "exercise" for rows in (self.stations, self.resources) for each in rows)

    @cached_property
    def positions(self) -> tuple[Array, Array]:
        """Latitude and longitude (n,) of all stations, degrees."""
        stations = self.stations
        return (
            np.array([each.latitude for each in stations], np.float64),
            np.array([each.longitude for each in stations], np.float64),
        )

    @cached_property
    def columns(self) -> Columns:
        """Values of all resources as arrays."""
        resources, (latitude, longitude) = self.resources, self.positions
        tanks = {each.code: (each.tank_l or np.nan) * WATER_KG_L for each in self.types}
        station = _integers(self.station_row[each.station] for each in resources)
        own = _floats(resources, lambda each: each.load_kg)
        least = _floats(resources, lambda each: tanks.get(each.type))
        return Columns(
            id=_integers(each.id for each in resources),
            station=station,
            latitude=latitude[station],
            longitude=longitude[station],
            count=_integers(each.count for each in resources),
            load_kg=np.where(np.isnan(own), least, own),
            speed_km_h=_floats(resources, lambda each: each.speed_km_h),
            mobilise_min=_floats(resources, lambda each: each.mobilise_min),
            radius_km=_floats(resources, lambda each: each.radius_km),
            line_m_h=_floats(resources, lambda each: each.line_m_h),
            cost_mobilise=_floats(resources, lambda each: each.cost_mobilise),
            cost_hour=_floats(resources, lambda each: each.cost_hour),
            cost_day=_floats(resources, lambda each: each.cost_day),
            night=np.array([each.night for each in resources], np.bool_),
        )

    @cached_property
    def windows(self) -> Windows:
        """Windows of availability as arrays."""
        row = {each.id: row for row, each in enumerate(self.resources)}
        begins = np.array([each.begins.timestamp() for each in self.availability], np.float64)
        order = np.argsort(begins, kind="stable")
        return Windows(
            _integers(row[each.resource] for each in self.availability)[order],
            order.astype(np.int64),
            begins[order],
            np.array([each.ends.timestamp() for each in self.availability], np.float64)[order],
            np.array([each.status == "available" for each in self.availability], np.bool_)[order],
        )

    @cached_property
    def codes(self) -> Codes:
        """Categorical columns of all resources."""
        types, resources = self.type_of, self.resources
        return Codes(
            kind=Categorical.from_values(types[each.type].kind for each in resources),
            type=Categorical.from_values(types[each.type].type for each in resources),
            mode=Categorical.from_values(each.mode for each in resources),
            staffing=Categorical.from_values(each.staffing for each in resources),
            currency=Categorical.from_values(each.currency for each in resources),
        )


def _floats(resources: Sequence[Resource], value: Callable[[Resource], float | None]) -> Array:
    found = (value(each) for each in resources)
    return np.array([np.nan if each is None else each for each in found], np.float64)


def _integers(values: Iterable[int]) -> NDArray[np.int64]:
    return np.fromiter(values, np.int64)
