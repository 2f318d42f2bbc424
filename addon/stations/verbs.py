"""Verbs of `firetwin stations`, and the query of `firetwin resources`."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

from firetwin_core.run import Run

from .. import output
from ..command import amend
from ..data import history
from ..errors import InputError, UsageError, input_error
from ..progress import count, result, say
from ..run import labels, times, zone
from . import exercise, ignition, importers, merging, page, reading, search, station_search, writing
from .import_options import ImportOptions
from .import_rows import Batch
from .query import Query
from .records import EXERCISE


@dataclass(frozen=True)
class Fire:
    """A run, and the head of its fire at a time: degrees north and east, None if nothing burns."""

    run: Run
    head: Callable[[datetime], tuple[float, float] | None]


OpenFire = Callable[[Path], Fire]


def run_stations(arguments: argparse.Namespace, fire: OpenFire) -> None:
    """Run a verb of `firetwin stations`."""
    if arguments.verb == "info":
        show_info(arguments)
    elif arguments.verb == "import":
        import_files(arguments)
    else:
        make_exercise(arguments, fire)


def import_files(arguments: argparse.Namespace) -> None:
    """Make a station file from other files."""
    _check_out(arguments)
    about = merging.SourceOptions(arguments.source, arguments.licence, arguments.date or "", arguments.url)
    batches = _read_files(arguments)
    station_file, messages = merging.merge(batches, about)
    for message in messages:
        say(message)
    if not station_file.stations:
        reason = "has no valid station" + ("" if len(batches) == 1 else ", and neither have the other files")
        raise input_error(arguments.files[0], reason)
    _check_every_file_gave(arguments, batches)
    if any(source.licence == merging.NO_LICENCE for source in station_file.sources):
        say("a source has no licence; give --source and --licence before you publish the data")
    writing.write(station_file, arguments.out, arguments.overwrite)
    result(arguments.out)


def _read_files(arguments: argparse.Namespace) -> list[tuple[Path, Batch]]:
    """Read the files; with --skip-bad, files that cannot be read are named and omitted."""
    options = ImportOptions(dict(arguments.column), arguments.crs or "")
    batches = []
    for path in arguments.files:
        try:
            batches.append((path, importers.read(path, options)))
        except InputError as error:
            if not arguments.skip_bad:
                raise
            say(f"skipped: {error}")
    return batches


def _check_every_file_gave(arguments: argparse.Namespace, batches: list[tuple[Path, Batch]]) -> None:
    """Check that each file has a valid row, unless --skip-bad is set.

    Raises
    ------
    InputError
        A file has none.
    """
    for path, batch in batches:
        content = batch.station_file
        if (
            not (batch.stations or batch.resources or (content and content.stations))
            and not arguments.skip_bad
        ):
            lines = "; ".join(batch.rejected.lines()) or "it has no rows"
            raise input_error(path, f"gave no station: {lines}; correct it, or omit it with --skip-bad")


def make_exercise(arguments: argparse.Namespace, fire: OpenFire) -> None:
    """Invent an exercise around the fire of a run."""
    _check_out(arguments)
    run = fire(arguments.run).run
    known = run.event in history.events()
    if arguments.towns is None and not known:
        reason = "is not a known fire with published towns; name a list of bases with --towns"
        raise input_error(arguments.run, reason)
    if arguments.towns is None:
        station_file = exercise.make_for_event(run.event, arguments.seed)
    else:
        begins, ends = (times.utc(run, float(run.times[index])) for index in (0, -1))
        station_file = exercise.make(
            labels.read(arguments.towns), begins, ends + timedelta(days=7), zone.time_zone(run), run.name,
            arguments.towns.name, arguments.seed,
        )  # fmt: skip
    if not station_file.stations:
        raise input_error(arguments.towns or arguments.run, "lists no site for a base; list at least one")
    writing.write(station_file, arguments.out, arguments.overwrite)
    bases, resources = (
        count(len(station_file.stations), "base"),
        count(len(station_file.resources), "resource"),
    )
    say(f"{bases} with {resources}, all invented. {EXERCISE}")
    result(arguments.out)


def show_info(arguments: argparse.Namespace) -> None:
    """List the content of a station file."""
    facts = page.facts(reading.read(arguments.file))
    result(json.dumps(facts, indent=1, ensure_ascii=False) if arguments.json else page.format_facts(facts))


def find_resources(arguments: argparse.Namespace, fire: OpenFire) -> int:
    """List the resources or stations that match a query; return 1 if no set delivers enough."""
    _check_query(arguments)
    station_file = reading.read(arguments.file)
    opened = fire(arguments.run) if arguments.run else None
    query = _query(arguments, _near(arguments, opened))
    if arguments.stations or not station_file.resources:
        _check_stations(arguments)
        matches: search.ResourceMatches | station_search.StationMatches = station_search.survey(
            station_file, query
        )
    else:
        matches = search.survey(station_file, query)
    run = opened.run if opened else None
    answer = amend(arguments, page.SearchAnswer(station_file, query, matches, run))
    if arguments.ahead:
        if run is None and not answer.further:
            raise UsageError("--ahead: needs the fire of a run; name it with --run")
        answer = answer.ahead(arguments.clearance)
    result(
        json.dumps(answer.as_json(), indent=1, ensure_ascii=False) if arguments.json else answer.format_text()
    )
    if answer.shortfall:
        say(f"no set: {answer.shortfall}")
        return 1
    return 0


def _check_query(arguments: argparse.Namespace) -> None:
    """Check that options have those that they need.

    Raises
    ------
    UsageError
        One is missing.
    """
    if arguments.near in ("ignition", "head") and arguments.run is None:
        raise UsageError(f"--near: {arguments.near} needs the fire of a run; name it with --run")
    if arguments.near == "head" and arguments.available_at is None:
        raise UsageError("--near: head needs a time; give it with --available-at")
    for name in ("within", "minutes", "tonnes_per_hour"):
        if getattr(arguments, name) is not None and arguments.near is None:
            raise UsageError(f"--{name.replace('_', '-')}: needs a destination; give it with --near")


def _check_stations(arguments: argparse.Namespace) -> None:
    asked = {
        "minutes": arguments.minutes, "kind": arguments.kind, "type": arguments.type, "mode": arguments.mode,
        "staffing": arguments.staffing, "night": arguments.night, "budget": arguments.budget,
        "tonnes-per-hour": arguments.tonnes_per_hour,
    }  # fmt: skip
    for name, value in asked.items():
        if value:
            why = "--stations lists stations" if arguments.stations else f"{arguments.file} has none"
            raise UsageError(f"--{name}: is a condition on resources, but {why}")


def _near(arguments: argparse.Namespace, fire: Fire | None) -> tuple[float, float] | None:
    """Return the coordinates of the destination; print the coordinates of `ignition` and `head`."""
    if fire is None or not isinstance(arguments.near, str):
        return arguments.near
    if arguments.near == "head":
        position, source = fire.head(arguments.available_at), "the run's front"
    else:
        position, source = ignition.find(fire.run) or (None, "")
    if position is None:
        raise input_error(arguments.run, f"has no fire and therefore no {arguments.near}; give LAT,LON")
    say(f"{arguments.near}: {position[0]:.4f}, {position[1]:.4f} ({source})")
    return position


def _query(arguments: argparse.Namespace, near: tuple[float, float] | None) -> Query:
    return Query(
        near=near,
        within_km=arguments.within,
        minutes=arguments.minutes,
        kinds=arguments.kind,
        types=arguments.type,
        modes=arguments.mode,
        staffing=arguments.staffing,
        night=arguments.night,
        at=arguments.available_at,
        tonnes_per_hour=arguments.tonnes_per_hour,
        budget=arguments.budget,
        currency=arguments.currency,
        hours=arguments.hours,
        detour=arguments.detour,
        refill_km=arguments.refill,
        turnaround_min=arguments.turnaround,
    )


def _check_out(arguments: argparse.Namespace) -> None:
    out: Path = arguments.out
    if out.suffix.lower() != ".gpkg":
        raise UsageError(f"--out: {out} does not end in .gpkg; name a .gpkg file")
    output.check(out, arguments.overwrite)
