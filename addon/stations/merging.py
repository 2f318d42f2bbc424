"""Merging of import batches: numbered sources, merged duplicates, resources assigned to stations."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ..progress import count
from . import names, types
from .distance import distance_km
from .import_rows import Batch, ResourceDraft
from .records import Area, Availability, Resource, Source, Station, Type
from .station_file import StationFile

NEAR = 150.0  # m, within which stations of similar name and equal kind are duplicates
_DEGREE = 111_000.0  # m of latitude, at least 110,574
NO_LICENCE = "not stated"
_NO_STATION = "unknown station"
_MANY_STATIONS = "several stations have this name (use the number)"


@dataclass(frozen=True)
class SourceOptions:
    """Source of the files, as the user gives it; empty: as the format or the file gives it."""

    name: str = ""
    licence: str = ""
    retrieved: str = ""
    url: str = ""


@dataclass
class _Merged:
    """Content merged so far."""

    stations: list[Station] = field(default_factory=list)
    resources: list[Resource] = field(default_factory=list)
    availability: list[Availability] = field(default_factory=list)
    sources: list[Source] = field(default_factory=list)
    types: dict[str, Type] = field(default_factory=dict)
    areas: list[Area] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)


def merge(batches: Sequence[tuple[Path, Batch]], about: SourceOptions) -> tuple[StationFile, list[str]]:
    """Merge all batches; also return messages on the rows imported, merged, rejected and dropped.

    Tables of resources come after all stations, independent of the order of the files.
    """
    merged = _Merged(types={each.code: each for each in types.standard_types()})
    for path, batch in sorted(batches, key=lambda pair: bool(pair[1].resources)):
        if batch.station_file is not None:
            _add_station_file(merged, batch.station_file)
            stations, resources = len(batch.station_file.stations), len(batch.station_file.resources)
            merged.messages.append(f"{path}: {_format_counts(stations, resources)}")
            continue
        source = _source(merged, path, batch, about)
        _add_stations(merged, batch, source)
        number = _add_resources(merged, batch, source)
        _report(merged, path, batch, source, number)
    _merge_duplicates(merged)
    station_file = StationFile(
        tuple(merged.stations), tuple(merged.resources), tuple(merged.availability), tuple(merged.sources),
        tuple(merged.types.values()), tuple(merged.areas),
    )  # fmt: skip
    return station_file, merged.messages


def _format_counts(stations: int, resources: int) -> str:
    parts = [count(stations, "station")] if stations or not resources else []
    return " and ".join(parts + ([count(resources, "resource")] if resources else []))


def _source(merged: _Merged, path: Path, batch: Batch, about: SourceOptions) -> Source:
    """Return the source of a file; its date is the date of the file if no other is given."""
    changed = datetime.fromtimestamp(path.stat().st_mtime, UTC).date().isoformat()
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    source = Source(
        len(merged.sources) + 1,
        about.name or batch.name,
        about.licence or batch.licence or NO_LICENCE,
        about.retrieved or batch.retrieved or changed,
        about.url or batch.url,
        digest,
    )
    merged.sources.append(source)
    return source


def _report(merged: _Merged, path: Path, batch: Batch, source: Source, resources: int) -> None:
    what = _format_counts(len(batch.stations), resources)
    about = f"source {source.name}, licence {source.licence}, data of {source.retrieved}"
    merged.messages.append(f"{path}: {what}; {about}")
    merged.messages += [f"{path}: {line}" for line in (*batch.notes, *batch.rejected.lines())]
    if batch.dropped:
        listed = ", ".join(batch.dropped)
        merged.messages.append(f"{path}: telephone numbers and persons are not stored ({listed})")


def _add_stations(merged: _Merged, batch: Batch, source: Source) -> None:
    first = max((each.id for each in merged.stations), default=0) + 1
    for number, draft in enumerate(batch.stations, first):
        merged.stations.append(
            Station(
                number, draft.name, draft.latitude, draft.longitude, draft.origin, source.id, draft.kind,
                draft.agency, draft.address, draft.source_id, staffing=draft.staffing,
            )
        )  # fmt: skip


def _add_resources(merged: _Merged, batch: Batch, source: Source) -> int:
    """Add resources with a known station and return their number.

    Further rows with the same name and station add windows of availability.
    """
    by_word = _stations_by_word(merged.stations)
    number = max((each.id for each in merged.resources), default=0)
    numbers: dict[tuple[int, str, str], int] = {}
    for draft in batch.resources:
        station = _station_of(by_word, draft, batch)
        if station is None:
            continue
        key = station, draft.resource.type, draft.resource.name
        if key not in numbers or draft.window is None:
            number += 1
            numbers[key] = number
            made = replace(draft.resource, id=number, station=station, source=source.id)
            merged.resources.append(made)
            own = types.user_type(made.type)
            if own is not None:
                merged.types.setdefault(own.code, own)
        if draft.window is not None:
            begins, ends, status, area = draft.window
            merged.availability.append(Availability(numbers[key], begins, ends, status, area))
    return len(numbers)


def _stations_by_word(stations: Iterable[Station]) -> dict[str, set[int]]:
    """Index the numbers of stations by name and by number in the source, both in lower case."""
    found: dict[str, set[int]] = {}
    for station in stations:
        for word in {station.name.lower(), station.source_id.lower()} - {""}:
            found.setdefault(word, set()).add(station.id)
    return found


def _station_of(by_word: dict[str, set[int]], draft: ResourceDraft, batch: Batch) -> int | None:
    found = by_word.get(draft.station.lower(), set())
    if len(found) != 1:
        batch.rejected.add(_MANY_STATIONS if found else _NO_STATION, draft.place)
        return None
    return next(iter(found))


def _add_station_file(merged: _Merged, station_file: StationFile) -> None:
    """Add a station file with new numbers."""
    source, station, resource, area = (
        max((each.id for each in rows), default=0)
        for rows in (merged.sources, merged.stations, merged.resources, merged.areas)
    )
    merged.sources += [replace(each, id=each.id + source) for each in station_file.sources]
    merged.stations += [
        replace(each, id=each.id + station, source=each.source + source) for each in station_file.stations
    ]
    merged.resources += [
        replace(each, id=each.id + resource, station=each.station + station, source=each.source + source)
        for each in station_file.resources
    ]
    merged.availability += [
        replace(each, resource=each.resource + resource) for each in station_file.availability
    ]
    merged.areas += [
        replace(each, id=each.id + area, station=each.station + station) for each in station_file.areas
    ]
    merged.types.update({each.code: each for each in station_file.types if each.code not in merged.types})


def _merge_duplicates(merged: _Merged) -> None:
    """Merge duplicates within `NEAR` into the first station, which takes over missing values."""
    into = find_duplicates(merged.stations)
    if not into:
        return
    by_id = {each.id: each for each in merged.stations}
    for other, first in into.items():
        kept, gone = by_id[first], by_id[other]
        names_of = ("agency", "address", "staffing")
        missing = {name: getattr(gone, name) for name in names_of if not getattr(kept, name)}
        by_id[first] = replace(kept, **missing)
    merged.stations = [by_id[each.id] for each in merged.stations if each.id not in into]
    merged.resources = [
        replace(each, station=into.get(each.station, each.station)) for each in merged.resources
    ]
    merged.areas = [replace(each, station=into.get(each.station, each.station)) for each in merged.areas]
    what = "duplicate" if len(into) == 1 else "duplicates"
    merged.messages.append(f"{len(into):,} {what} merged (within {NEAR:g} m, similar name, same kind)")


def find_duplicates(stations: Sequence[Station]) -> dict[int, int]:
    """Map the number of each duplicate to the station that keeps it; exercise stations are never merged."""
    latitude = np.array([each.latitude for each in stations])
    order = np.argsort(latitude, kind="stable")
    ends = np.searchsorted(latitude[order], latitude[order] + NEAR / (_DEGREE - 500.0), "right")
    pairs = [
        (int(order[low]), int(order[high]))
        for low, end in enumerate(ends.tolist())
        for high in range(low + 1, end)
        if _may_be_duplicates(stations[order[low]], stations[order[high]])
    ]
    into: dict[int, int] = {}
    for one, other in sorted((min(pair), max(pair)) for pair in pairs):
        first, second = stations[one], stations[other]
        if first.id in into or second.id in into:
            continue
        (far,) = distance_km([first.latitude], [first.longitude], (second.latitude, second.longitude))
        if far * 1000.0 <= NEAR:
            into[second.id] = first.id
    return into


def _may_be_duplicates(one: Station, other: Station) -> bool:
    """Return True if two stations of similar latitude can be duplicates; distance is checked later."""
    return (
        abs(one.longitude - other.longitude) < 0.1
        and one.kind == other.kind
        and "exercise" not in (one.origin, other.origin)
        and names.may_be_equal(one.name, other.name)
    )
