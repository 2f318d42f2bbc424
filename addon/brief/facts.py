"""Facts of a resource with units, and its availability during the run."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from zoneinfo import ZoneInfo

from ..run import times
from ..run.measure import Units
from ..stations.records import Availability, Resource, Type
from ..stations.station_file import StationFile
from . import units

_OF_TYPE = {
    "tank_l": ("tank", "l"),
    "payload_kg": ("payload", "kg"),
    "pump_l_min": ("pump", "l/min"),
    "people": ("people", ""),
}
"""Label and unit of the minimum values of a resource type."""
_OWN = {
    "load_kg": ("load", "kg"),
    "line_m_h": ("line", "m/h"),
    "speed_km_h": ("speed", "km/h"),
    "mobilise_min": ("mobilises in", "min"),
    "radius_km": ("radius", "km"),
}
"""Label and unit of the values of a single resource."""
_COSTS = {"cost_mobilise": "to mobilise", "cost_hour": "per hour", "cost_day": "per day"}


def facts(station_file: StationFile, resource: Resource, order: Units = "us") -> str:
    """Describe one unit: ``tank at least 500 gal (1,893 l), speed 37.3 mph (60 km/h), ...``."""
    type_ = station_file.type_of[resource.type]
    return ", ".join(
        (*_numbers(type_, _OF_TYPE, order, " at least"), *_numbers(resource, _OWN, order), *_words(resource))
    )


def _numbers(
    of: Type | Resource, known: dict[str, tuple[str, str]], order: Units, more: str = ""
) -> Iterator[str]:
    for key, (label, unit) in known.items():
        value = getattr(of, key)
        if value is not None:
            yield f"{label}{more} {units.quantity(value, unit, order)}"


def _words(resource: Resource) -> Iterator[str]:
    for key, what in _COSTS.items():
        if value := getattr(resource, key):
            yield " ".join(filter(None, ("cost", f"{value:,.0f}", resource.currency, what)))
    yield f"mode {resource.mode}"
    if resource.staffing:
        yield f"staffing {resource.staffing}"
    yield "works at night" if resource.night else "does not work at night"


def availability(
    station_file: StationFile, resource: Resource, zone: str, span: tuple[datetime, datetime]
) -> Iterator[str]:
    """Describe the windows that overlap a time span (UTC) in local time, and count the others."""
    shown = windows(station_file, resource, zone, span)
    yield from shown
    if left := len(station_file.windows_of[resource.id]) - len(shown):
        yield f"{left} more periods before or after the run"


def windows(
    station_file: StationFile, resource: Resource, zone: str, span: tuple[datetime, datetime]
) -> list[str]:
    """Describe the windows that overlap a time span (UTC) in local time."""
    return [_window(each, zone) for each in _overlapping(station_file, resource, span)]


def short_windows(
    station_file: StationFile,
    resource: Resource,
    zone: str,
    span: tuple[datetime, datetime],
    areas: bool = True,
) -> list[str]:
    """Describe these windows without year, zone and the word available: ``17 Sep 16:00-20:00 committed``.

    Windows of the status "unavailable" are omitted if there are others; areas of use, without `areas`.
    """
    windows = _overlapping(station_file, resource, span)
    texts = []
    for each in [each for each in windows if each.status != "unavailable"] or windows:
        begins, ends = (when.astimezone(ZoneInfo(zone)) for when in (each.begins, each.ends))
        last = f"-{ends:%H:%M}" if begins.date() == ends.date() else f" to {ends.day} {ends:%b %H:%M}"
        status = "" if each.status == "available" else each.status
        area = f", area {each.area}" if areas and each.area else ""
        texts.append(f"{begins.day} {begins:%b %H:%M}{last} {status}".rstrip() + area)
    return texts


def _overlapping(
    station_file: StationFile, resource: Resource, span: tuple[datetime, datetime]
) -> list[Availability]:
    first, last = span
    known = station_file.windows_of[resource.id]
    return [each for each in known if each.begins <= last and each.ends > first]


def _window(window: Availability, zone: str) -> str:
    begins, ends = (times.text(when, zone) for when in (window.begins, window.ends))
    return f"{begins} to {ends}: {', '.join(filter(None, (window.status, window.area)))}"
