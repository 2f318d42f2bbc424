"""Printed tables of resources: a line each as in form ICS 204, and totals by type as in ICS 215."""

from __future__ import annotations

from collections.abc import Iterable
from zoneinfo import ZoneInfo

from ..html_text import quote
from ..stations.records import Resource, Station
from . import facts
from .briefing import Briefing

_LINES = ("Resource", "Number", "People", "Leader, contact", "Station", "Available", "Origin")
_TOTALS = ("Type", "Number", "People, at least", "Stations")


def tables(briefing: Briefing) -> str:
    """Build both tables, which only the print shows; empty without resources."""
    stations = [point.station for point in briefing.points if point.station is not None]
    rows = [(station, each) for station in stations for each in briefing.resources(station)]
    if not rows:
        return ""
    zone = ZoneInfo(briefing.zone)
    totals = _table("Resources by type", _TOTALS, _totals(briefing, rows))
    title = f"Resources; available in local time, {briefing.fronts[0].utc.astimezone(zone):%Y} ({zone.key})"
    lines = _table(title, _LINES, (_line(briefing, *row) for row in rows))
    return f'<div class="print-only">{totals}{lines}</div>'


def _table(caption: str, head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    top = "".join(f'<th scope="col">{name}</th>' for name in head)
    inside = "".join(
        "<tr>" + "".join(f"<td>{quote(value)}</td>" for value in row) + "</tr>\n" for row in rows
    )
    return (
        f'<table class="resources"><caption>{caption}</caption><thead><tr>{top}</tr></thead>'
        f"<tbody>{inside}</tbody></table>"
    )


def _people(briefing: Briefing, resource: Resource) -> int | None:
    """Multiply the people of a unit of this type by the number of units."""
    file = briefing.station_file
    people = file.type_of[resource.type].people if file else None
    return None if people is None else int(people) * resource.count


def _line(briefing: Briefing, station: Station, resource: Resource) -> tuple[object, ...]:
    file = briefing.station_file
    assert file is not None
    span = briefing.fronts[0].utc, briefing.fronts[-1].utc
    available = "; ".join(facts.short_windows(file, resource, briefing.zone, span))
    people = _people(briefing, resource)
    name = ", ".join(filter(None, (resource.type, resource.name)))
    return (
        name,
        resource.count,
        "" if people is None else people,
        "",
        station.title,
        available,
        resource.origin,
    )


def _totals(briefing: Briefing, rows: list[tuple[Station, Resource]]) -> list[tuple[object, ...]]:
    found: list[tuple[object, ...]] = []
    for code in sorted({resource.type for _, resource in rows}):
        own = [(station, each) for station, each in rows if each.type == code]
        people = [_people(briefing, each) for _, each in own]
        known = "" if None in people else sum(filter(None, people))
        count = sum(each.count for _, each in own)
        found.append((code, f"{count:,}", known, len({station.id for station, _ in own})))
    return found
