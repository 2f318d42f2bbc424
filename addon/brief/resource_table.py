"""Printed tables of resources: by station, a line each as in form ICS 204; totals by type as in ICS 215."""

from __future__ import annotations

from collections.abc import Iterable
from zoneinfo import ZoneInfo

from ..html_text import quote
from ..stations.records import Resource, Station
from . import facts
from .briefing import Briefing

_LINES = ("Resource", "Number", "People", "Leader, contact", "Available", "Origin")
_TOTALS = ("Type", "Number", "People, at least", "Stations")

Row = tuple[object, ...]


def tables(briefing: Briefing) -> str:
    """Build both tables, which only the print shows; empty without resources."""
    stations = [point.station for point in briefing.points if point.station is not None]
    rows = [(station, each) for station in stations for each in briefing.resources(station)]
    if not rows:
        return ""
    zone = ZoneInfo(briefing.zone)
    totals = _table("Resources by type", _TOTALS, [_body(_totals(briefing, rows))], "totals")
    areas = _areas(briefing, rows)
    common = f", area {areas.pop()}" if len(areas) == 1 and "" not in areas else ""
    title = (
        f"Resources by station; available in local time, {briefing.fronts[0].utc.astimezone(zone):%Y} "
        f"({zone.key}){common}; times stated as unavailable are omitted"
    )
    groups = [
        _body([_line(briefing, each, not common) for each in briefing.resources(station)], station.title)
        for station in stations
        if briefing.resources(station)
    ]
    lines = _table(title, _LINES, groups, "lines")
    return f'<div class="print-only">{totals}{lines}</div>'


def _table(caption: str, head: Iterable[str], bodies: Iterable[str], kind: str) -> str:
    top = "".join(f'<th scope="col">{name}</th>' for name in head)
    return (
        f'<table class="resources {kind}"><caption>{quote(caption)}</caption><thead><tr>{top}</tr></thead>'
        f"{''.join(bodies)}</table>"
    )


def _body(rows: Iterable[Row], title: str = "") -> str:
    """Build a group of rows, with a title above them."""
    inside = "".join(
        "<tr>" + "".join(f"<td>{quote(value)}</td>" for value in row) + "</tr>\n" for row in rows
    )
    head = f'<tr><th scope="rowgroup" colspan="{len(_LINES)}">{quote(title)}</th></tr>\n' if title else ""
    return f"<tbody>{head}{inside}</tbody>"


def _people(briefing: Briefing, resource: Resource) -> int | None:
    """Multiply the people of a unit of this type by the number of units."""
    file = briefing.station_file
    people = file.type_of[resource.type].people if file else None
    return None if people is None else int(people) * resource.count


def _areas(briefing: Briefing, rows: Iterable[tuple[Station, Resource]]) -> set[str]:
    """Collect the areas of use of all windows of resources."""
    file = briefing.station_file
    assert file is not None
    return {window.area for _, each in rows for window in file.windows_of[each.id]}


def _line(briefing: Briefing, resource: Resource, areas: bool) -> Row:
    file = briefing.station_file
    assert file is not None
    span = briefing.fronts[0].utc, briefing.fronts[-1].utc
    available = "; ".join(facts.short_windows(file, resource, briefing.zone, span, areas))
    people = _people(briefing, resource)
    name = ", ".join(filter(None, (resource.type, resource.name)))
    return name, resource.count, "" if people is None else people, "", available, resource.origin


def _totals(briefing: Briefing, rows: list[tuple[Station, Resource]]) -> list[Row]:
    totals: list[Row] = []
    for code in sorted({resource.type for _, resource in rows}):
        own = [(station, each) for station, each in rows if each.type == code]
        people = [_people(briefing, each) for _, each in own]
        known = "" if None in people else sum(filter(None, people))
        count = sum(each.count for _, each in own)
        totals.append((code, f"{count:,}", known, len({station.id for station, _ in own})))
    return totals
