"""Lists of stations with their resources, and of named places, with fire arrival times."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from ..html_text import quote
from ..stations.describe import degrees, web_map_address
from ..stations.records import EXERCISE, Resource, Station
from ..stations.station_file import StationFile
from . import facts, resource_table
from .briefing import Briefing, Point

_FIRE = (
    ("", "any"),
    ("now", "reached by the time shown"),
    ("reached", "reached during the run"),
    ("not_reached", "not reached"),
)


def section(briefing: Briefing) -> str:
    """Build search, filters and lists; empty without places."""
    if not briefing.points:
        return ""
    stations = [point for point in briefing.points if point.station is not None]
    towns = [point for point in briefing.points if point.station is None]
    title = "Fire arrival at stations and places" if stations else "Fire arrival at places"
    return "\n".join(
        (
            f'<section aria-labelledby="places-title"><h2 id="places-title">{title}</h2>',
            *_warning(briefing),
            _filters(briefing, [point.station for point in stations if point.station]),
            '<div class="list" tabindex="0" role="region" aria-label="Places">',
            *([_stations(briefing, stations)] if stations else []),
            *([_towns(briefing, towns)] if towns else []),
            f"</div>{_METHOD}{resource_table.tables(briefing)}</section>",
        )
    )


def _warning(briefing: Briefing) -> Iterator[str]:
    if briefing.station_file is not None and briefing.station_file.exercise:
        yield (
            f'<p class="warn"><b>{EXERCISE}.</b> Rows marked "exercise" are invented: positions of '
            "engines, crews, times and costs.</p>"
        )


def _filters(briefing: Briefing, stations: Sequence[Station]) -> str:
    kinds = sorted({station.kind for station in stations if station.kind})
    types = sorted({each.type for station in stations for each in briefing.resources(station)})
    origins = sorted({origin for station in stations for origin in briefing.origins(station)})
    selects = [
        *([_select("kind", "kind", [("", "all"), *_same([*kinds, "named place"])])] if stations else []),
        *([_select("types", "resource", [("", "all"), *_same(types)])] if types else []),
        *([_select("origin", "origin", [("", "all"), *_same(origins)])] if origins else []),
        _select("fire", "fire", _FIRE),
    ]
    return (
        '<div class="filters" role="search"><input type="search" id="search" placeholder="Search (press /)" '
        f'aria-label="Search places" autocomplete="off" spellcheck="false">{"".join(selects)}'
        '<span id="count" role="status" class="soft"></span></div>'
    )


def _same(words: Iterable[str]) -> list[tuple[str, str]]:
    return [(word, word) for word in words]


def _select(name: str, label: str, options: Iterable[tuple[str, str]]) -> str:
    inside = "".join(f'<option value="{quote(value)}">{quote(text)}</option>' for value, text in options)
    return f'<label>{label} <select name="{name}">{inside}</select></label>'


def _stations(briefing: Briefing, points: Sequence[Point]) -> str:
    head = ("Station, resource", "Kind and details", "Fire arrival", "Origin and source", "Position")
    sources = _sources(briefing, points)
    inside = "\n".join(_station(briefing, point, sources) for point in points)
    return _table(f"Stations and resources{_source_key(sources)}", head, inside)


def _sources(briefing: Briefing, points: Sequence[Point]) -> dict[str, str]:
    """Return the text of each source in rows, by its name: a number, or nothing for a single source."""
    station_file = briefing.station_file
    assert station_file is not None
    stations = [point.station for point in points if point.station is not None]
    used = [station.source for station in stations]
    used += [each.source for station in stations for each in briefing.resources(station)]
    names = list(dict.fromkeys(station_file.source_of[each].name for each in used))
    return {name: f"source {k}" if len(names) > 1 else "" for k, name in enumerate(names, 1)}


def _source_key(sources: dict[str, str]) -> str:
    """Name each source once, below the caption."""
    texts = (quote(f"{number}: {name}" if number else f"source: {name}") for name, number in sources.items())
    return f"<small>{'; '.join(texts)}</small>"


def _table(caption: str, head: Iterable[str], inside: str, kind: str = "") -> str:
    top = "".join(f'<th scope="col">{name}</th>' for name in head)
    return f"<table{kind}><caption>{caption}</caption><thead><tr>{top}</tr></thead>\n{inside}</table>"


def _station(briefing: Briefing, point: Point, sources: dict[str, str]) -> str:
    station, station_file = point.station, briefing.station_file
    assert station is not None and station_file is not None  # noqa: PT018
    resources, source = briefing.resources(station), sources[station_file.source_of[station.source].name]
    words = ", ".join(filter(None, (station.kind, station.agency)))
    types = "|".join(dict.fromkeys(resource.type for resource in resources))
    address = f"<small>{quote(station.address)}</small>" if station.address else ""
    rows = [
        f"<tr><td>{_button(point)}</td><td>{quote(words)}{address}</td><td>{_when(briefing, point)}</td>"
        f"<td>{_origin(station.origin, source)}</td><td>{_web_map(point)}</td></tr>",
        *(_resource(briefing, station_file, station, resource, sources) for resource in resources),
    ]
    data = _data(point, station.kind, "|".join(sorted(briefing.origins(station))), types)
    return f"<tbody {data}>{''.join(rows)}</tbody>"


def _resource(
    briefing: Briefing,
    station_file: StationFile,
    station: Station,
    resource: Resource,
    sources: dict[str, str],
) -> str:
    number = f"{resource.count:,} × " if resource.count > 1 else ""
    span = briefing.fronts[0].utc, briefing.fronts[-1].utc
    lines = [resource.note, *facts.availability(station_file, resource, briefing.zone, span)]
    small = "".join(f"<small>{quote(line)}</small>" for line in lines if line)
    name = f"{number}{resource.type}" + (f", {resource.name}" if resource.name else "")
    name_of = station_file.source_of[resource.source].name
    source = sources[name_of] if resource.source != station.source else ""
    return (
        f'<tr class="resource"><td>{quote(name)}</td>'
        f'<td colspan="2">{quote(facts.facts(station_file, resource, briefing.units))}{small}</td>'
        f"<td>{_origin(resource.origin, source)}</td><td></td></tr>"
    )


def _towns(briefing: Briefing, points: Sequence[Point]) -> str:
    rows = "\n".join(_town(briefing, point) for point in points)
    head = ("Place", "Fire arrival", "Position")
    return _table("Named places", head, f"<tbody>{rows}</tbody>", ' class="plain"')


def _town(briefing: Briefing, point: Point) -> str:
    cells = (_button(point), _when(briefing, point), _web_map(point))
    inside = "".join(f"<td>{cell}</td>" for cell in cells)
    return f"<tr {_data(point, 'named place', '', '')}>{inside}</tr>"


def _data(point: Point, kind: str, origins: str, types: str) -> str:
    fire = {"before": "reached"}.get(point.reached.state, point.reached.state)
    pairs = {"id": point.id, "kind": kind, "origin": origins, "types": types, "fire": fire}
    return " ".join(f'data-{key}="{quote(value)}"' for key, value in pairs.items())


def _button(point: Point) -> str:
    name = quote(point.name)
    return f'<button type="button" class="name" title="Show on the map">{name}</button>'


def _when(briefing: Briefing, point: Point) -> str:
    text = point.reached.text
    return f'<span class="when">{quote(text.headline)}</span><small>{quote(text.note)}</small>'


def _origin(origin: str, source: str) -> str:
    more = f"<small>{quote(source)}</small>" if source else ""
    return f'<span class="tag {origin}">{origin}</span>{more}'


def _web_map(point: Point) -> str:
    """Build a plain link, which loads nothing until it is followed."""
    at, address = degrees(point.latitude, point.longitude), web_map_address(point.latitude, point.longitude)
    label = quote(f"Open {point.name} in web map")
    return (
        f'<a href="{quote(address)}" target="_blank" rel="noopener noreferrer" aria-label="{label}">'
        f"Open in web map</a><small>{quote(', '.join(at))}</small>"
    )


_METHOD = (
    '<p class="soft">The arrival time at a place is interpolated between the centres of the four surrounding '
    "fuel cells. A place in a cell without fuel does not burn in a model: its row has the closest approach "
    "of the fire, to the centre of the nearest cell that burns. Suppression does not affect the simulated "
    "fire.</p>"
)
