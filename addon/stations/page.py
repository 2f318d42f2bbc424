"""Search results and file contents, as JSON data and as text."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from datetime import datetime
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from firetwin_core.run import Run

from ..escaped import escaped
from ..progress import count
from ..run import times, zone
from . import arrival_text, fire_arrival, search, station_search
from .query import Query
from .records import EXERCISE, Source
from .station_file import StationFile


class Further(Protocol):
    """Further arrivals at the stations of the matches.

    `name` is their key in JSON data, `late` the reason to omit stations that `ahead` omits.
    """

    name: str
    late: str

    def heads(self) -> list[str]:
        """Return the titles of the columns."""

    def cells(self, station: int) -> list[str]:
        """Return the cells of a station."""

    def as_json(self, station: int) -> dict[str, Any]:
        """Return JSON data of a station."""

    def ahead(self, after: datetime | None) -> list[int]:
        """List stations that the fire reaches after a time, earliest first."""

    def notes(self) -> list[str]:
        """Describe the arrivals."""

    def select(self, order: list[int]) -> Further:
        """Return the arrivals at these stations."""


@dataclass(frozen=True)
class SearchAnswer:
    """Result of a search, with the fire of a run, and further arrivals, if they are given."""

    station_file: StationFile
    query: Query
    found: search.ResourceMatches | station_search.StationMatches
    run: Run | None = None
    further: tuple[Further, ...] = ()

    @property
    def shortfall(self) -> str:
        """Reason why no set delivers enough; empty if there is a set, and for stations."""
        return self.found.shortfall if isinstance(self.found, search.ResourceMatches) else ""

    @property
    def matches(self) -> Sequence[search.Match | station_search.StationMatch]:
        """Matches in the order of the list."""
        return self.found.matches

    @cached_property
    def arrivals(self) -> fire_arrival.Arrivals | None:
        """Arrival of the fire at the station of each match."""
        if self.run is None:
            return None
        at = [each.station for each in self.matches]
        return fire_arrival.sample(self.run, [each.latitude for each in at], [each.longitude for each in at])

    def ahead(self, clearance_km: float) -> SearchAnswer:
        """Select the stations that the fire reaches or approaches, after the time of the query if it has one.

        They are sorted by this time. Stations on ground that burned before the run are omitted. Without a
        run, the first further arrivals decide.
        """
        if self.run is None and self.further:
            return self._ahead_of(self.further[0])
        arrivals, run = self.arrivals, self.run
        if arrivals is None or run is None:
            return self
        then = -np.inf if self.query.at is None else times.seconds(run, self.query.at)
        close = (arrivals.nearest_km <= clearance_km) & (arrivals.state != fire_arrival.BEFORE)
        keep = close & (arrivals.nearest_time > max(then, float(run.times[0])))
        reasons = Counter(
            "fire: there before that time" if near else f"fire: {fire_arrival.STATES[state]}"
            for near, state in zip(close[~keep].tolist(), arrivals.state[~keep].tolist(), strict=True)
        )
        order = np.flatnonzero(keep)
        order = order[np.argsort(arrivals.nearest_time[order], kind="stable")]
        return self._select(order.tolist(), dict(reasons))

    def _ahead_of(self, further: Further) -> SearchAnswer:
        order = further.ahead(self.query.at)
        omitted = len(self.found.matches) - len(order)
        return self._select(order, {further.late: omitted} if omitted else {})

    def _select(self, order: list[int], reasons: dict[str, int]) -> SearchAnswer:
        """Keep matches by their indices; the others are omitted for these reasons."""
        result, further = self.found, tuple(each.select(order) for each in self.further)
        matches: Any = [result.matches[k] for k in order]
        kept = replace(result, matches=matches, left_out=result.left_out | reasons)
        return replace(self, found=kept, further=further)

    @property
    def exercise(self) -> bool:
        """True if a row of the file was invented."""
        return self.station_file.exercise

    @property
    def sources(self) -> list[Source]:
        """Sources of all matches."""
        used = {number for each in self.matches for number in _sources(each)}
        return [source for source in self.station_file.sources if source.id in used]

    def assumptions(self) -> list[str]:
        """Return units and assumptions of the list."""
        query, of_resources = self.query, isinstance(self.found, search.ResourceMatches)
        lines = []
        if query.near is not None:
            lines.append(f"distances: straight to {query.near[0]:.4f}, {query.near[1]:.4f}, km")
        if of_resources:
            lines += [
                f"minutes: getaway and travel time; roads are {query.detour:g} times the straight distance, "
                "aircraft fly straight",
                f"cost: mobilisation and {query.hours:g} h of work",
                "t/h: load, or the minimum tank of the type full of water, by round trips to a refill point "
                f"{query.refill_km:g} km away (air tankers: to their base), with "
                f"{query.turnaround_min:g} min to fill and discharge",
            ]
        if self.run is not None:
            first, last = (self._text(float(self.run.times[k])) for k in (0, -1))
            lines.append(f"fire: run {self.run.name}, {first} to {last}")
            lines.append(f"fire: times {arrival_text.format_resolution(self.run)}")
            if not self.run.has(fire_arrival.ARRIVAL_FIELD):
                lines.append(
                    "fire: times are estimated from heat fluxes; ground burned before the run counts as not "
                    "reached"
                )
        return lines + [note for each in self.further for note in each.notes()]

    def as_json(self) -> dict[str, Any]:
        """Return JSON data; lengths in km, times in UTC."""
        query = asdict(self.query)
        query["at"] = times.iso(self.query.at) if self.query.at else None
        answer = {
            "exercise": self.exercise,
            "label": EXERCISE if self.exercise else "",
            "query": query,
            "assumptions": self.assumptions(),
            "sources": [asdict(source) for source in self.sources],
            "left_out": self.found.left_out,
            "shortfall": self.shortfall,
            "matches": [
                asdict(each)
                | ({"fire": self._fire(k)} if self.run else {})
                | {further.name: further.as_json(k) for further in self.further}
                for k, each in enumerate(self.matches)
            ],
        }
        if isinstance(self.found, search.ResourceMatches):
            answer |= {
                "cost": self.found.cost,
                "tonnes_per_hour": self.found.tonnes_per_hour,
                "candidates": self.found.candidates,
            }
        return answer

    def format_text(self) -> str:
        """Format the result as text."""
        result, lines = self.found, [EXERCISE] if self.exercise else []
        rows = [self._row(k, each) for k, each in enumerate(self.matches)]
        if rows:
            heads = ["km", "origin", "station"]
            if isinstance(result, search.ResourceMatches):
                heads = [
                    "min",
                    "km",
                    "t/h",
                    f"cost, {self.query.currency}",
                    "type",
                    "origin",
                    "resource",
                    "station",
                ]
            more = [
                *(["fire"] if self.run else []),
                *(head for each in self.further for head in each.heads()),
            ]
            lines += _table(heads + more, rows)
        lines.append(self._sum())
        lines += [f"left out: {number:,} {reason}" for reason, number in result.left_out.items()]
        lines += self.assumptions()
        lines += [_source_line(asdict(source)) for source in self.sources]
        return "\n".join(lines)

    def _sum(self) -> str:
        result = self.found
        if not isinstance(result, search.ResourceMatches):
            return count(len(self.matches), "station")
        text = count(len(result.matches), "resource")
        if result.candidates:
            text += f" of {result.candidates:,}: {result.cost:,.0f} {self.query.currency}"
        return text + (f", {result.tonnes_per_hour:.1f} t/h" if result.matches else "")

    def _row(self, index: int, match: search.Match | station_search.StationMatch) -> list[str]:
        fire = [self._arrival_text(index).headline] if self.run else []
        fire += [cell for each in self.further for cell in each.cells(index)]
        if isinstance(match, station_search.StationMatch):
            return [_number(match.distance_km, 1), match.station.origin, escaped(match.station.name), *fire]
        each = match.resource
        name = escaped(each.name) + (f" ({each.count})" if each.count > 1 else "")
        return [
            _number(match.minutes, 0), _number(match.distance_km, 1), _number(match.tonnes_per_hour, 1),
            _number(match.cost, 0), escaped(each.type), each.origin, name, escaped(match.station.name), *fire,
        ]  # fmt: skip

    def _fire(self, index: int) -> dict[str, Any]:
        """Return the arrival of the fire at a match: state, text, closest approach, and times in UTC.

        The times of the surrounding cells limit the interpolation; they are not a forecast's uncertainty.
        """
        arrivals, run = self.arrivals, self.run
        assert arrivals is not None and run is not None  # noqa: PT018
        utc_times = arrivals.utc(run, index)
        names = ("time", "earliest_cell", "latest_cell")
        near = float(arrivals.nearest_km[index])
        there = None if np.isnan(near) else times.utc(run, float(arrivals.nearest_time[index]))
        return {
            "state": fire_arrival.STATES[arrivals.state[index]],
            "text": str(self._arrival_text(index)),
            "nearest_km": None if there is None else near,
            "nearest_time": None if there is None else times.iso(there),
        } | {name: None if utc_times is None else times.iso(utc_times[k]) for k, name in enumerate(names)}

    def _arrival_text(self, index: int) -> arrival_text.ArrivalText:
        arrivals, run = self.arrivals, self.run
        assert arrivals is not None and run is not None  # noqa: PT018
        return arrival_text.describe(run, arrivals, index, zone.time_zone(run))

    def _text(self, seconds: float) -> str:
        assert self.run is not None
        return fire_arrival.format_time(self.run, seconds)


def facts(station_file: StationFile) -> dict[str, Any]:
    """Return the content of a file for `firetwin stations info`."""
    latitude, longitude = station_file.positions
    there = len(latitude) > 0
    begins, ends = (
        _iso(pick((getattr(each, name) for each in station_file.availability), default=None))
        for pick, name in ((min, "begins"), (max, "ends"))
    )
    return {
        "exercise": station_file.exercise,
        "label": EXERCISE if station_file.exercise else "",
        "stations": len(station_file.stations),
        "resources": len(station_file.resources),
        "areas": len(station_file.areas),
        "origins": dict(
            Counter(each.origin for rows in (station_file.stations, station_file.resources) for each in rows)
        ),
        "types": dict(sorted(Counter(each.type for each in station_file.resources).items())),
        "latitude": [float(latitude.min()), float(latitude.max())] if there else None,
        "longitude": [float(longitude.min()), float(longitude.max())] if there else None,
        "windows": {"count": len(station_file.availability), "begins": begins, "ends": ends},
        "sources": [asdict(source) for source in station_file.sources],
    }


def format_facts(facts: dict[str, Any]) -> str:
    """Format `facts` as text."""
    lines = [facts["label"]] if facts["exercise"] else []
    lines.append(f"stations   {facts['stations']:,}")
    if facts["latitude"]:
        (south, north), (west, east) = facts["latitude"], facts["longitude"]
        lines.append(f"extent     {south:.4f} to {north:.4f} N, {west:.4f} to {east:.4f} E")
    lines.append(f"resources  {facts['resources']:,}")
    lines += [f"  {escaped(code):<14} {number:,}" for code, number in facts["types"].items()]
    if facts["areas"]:
        lines.append(f"areas      {facts['areas']:,}")
    lines += [f"origin     {origin}: {count(number, 'row')}" for origin, number in facts["origins"].items()]
    windows = facts["windows"]
    if windows["count"]:
        lines.append(f"windows    {windows['count']:,}, {windows['begins']} to {windows['ends']}")
    lines += [_source_line(source) for source in facts["sources"]]
    return "\n".join(lines)


def _iso(when: datetime | None) -> str | None:
    return None if when is None else times.iso(when)


def _source_line(source: dict[str, Any]) -> str:
    address = f" ({escaped(source['url'])})" if source["url"] else ""
    name, licence = escaped(source["name"]), escaped(source["licence"])
    return f"source     {name}, licence {licence}, data of {source['retrieved']}{address}"


def _sources(match: search.Match | station_search.StationMatch) -> set[int]:
    own = {match.resource.source} if isinstance(match, search.Match) else set()
    return {match.station.source, *own}


def _number(value: float | None, digits: int) -> str:
    return "?" if value is None else f"{value:,.{digits}f}"


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Format the lines of a table: numbers right-aligned, words left-aligned."""
    widths = [max(map(len, column)) for column in zip(heads, *rows, strict=True)]
    right = [head in ("min", "km", "t/h") or head.startswith("cost") for head in heads]
    return [
        "  ".join(
            cell.rjust(width) if to_right else cell.ljust(width)
            for cell, width, to_right in zip(row, widths, right, strict=True)
        ).rstrip()
        for row in (heads, *rows)
    ]
