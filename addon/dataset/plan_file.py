"""Plan reader: parses TOML into a validated `Plan`; errors name line and column."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..did_you_mean import suggestion
from ..errors import input_error, reading
from ..files import read_text
from ..limits import SETTINGS_BYTES
from ..shot.schema import either, key, validate
from ..shot.schema.bounds import file_name, twice
from ..shot.settings.scene_file import TableReader
from ..toml_text import Where, loads
from . import distributions, members
from .distributions import DEFAULTS, KINDS, VALUES, Constant, Distribution
from .plan import CameraShares, NegativeShares, Plan, PlanKeys, PlanRun, RunKeys, SplitShares

_EXAMPLE = "examples/dataset.toml shows every key"


@dataclass(frozen=True)
class _Run(RunKeys):
    """A run of the data set."""

    run: Path | None = key(None, "run folder, or scene file, whose settings apply, or ensemble")
    members: tuple[str, ...] = key((), 'members of an ensemble, each of which is a run, or "all"')


@dataclass(frozen=True)
class _File(PlanKeys):
    """Content of a plan, except the distributions."""

    runs: tuple[_Run, ...] = key((), "runs that the samples show")
    cameras: CameraShares = key(default_factory=CameraShares, help="kinds of camera")
    negatives: NegativeShares = key(default_factory=NegativeShares, help="kinds of sample without fire")
    splits: SplitShares = key(default_factory=SplitShares, help="splits")


def read(path: str | Path) -> Plan:
    """Read and validate a plan; relative paths start at its folder.

    Raises
    ------
    InputError
        The error names the file, line and column, and the remedy.
    """
    path = Path(path)
    if not path.is_file():
        raise input_error(path, f"there is no such plan; {_EXAMPLE}")
    with reading(path):
        return parse(read_text(path, "utf-8-sig", most=SETTINGS_BYTES), path)


def parse(text: str, path: Path) -> Plan:
    """Parse a text as if it were the file `path`.

    Raises
    ------
    InputError
        As `read`.
    """
    values = loads(path, text)
    reader = TableReader(path, text, "plan of a data set")
    drawn = reader.expect(dict, values.pop("draws", {}), ("draws",))
    content: _File = reader.table(_File, values, ())
    if invalid := validate(content):
        raise reader.error(*invalid)
    for where, reason in _faults(content):
        raise reader.error(where, reason)
    draws = {name: _distribution(reader, name, value) for name, value in drawn.items()}
    return Plan(
        path=path,
        runs=tuple(run for each in content.runs for run in _runs(each)),
        cameras=dataclasses.asdict(content.cameras),
        negatives=dataclasses.asdict(content.negatives),
        splits=dataclasses.asdict(content.splits),
        draws={**DEFAULTS, **draws},
        **{each.name: getattr(content, each.name) for each in dataclasses.fields(PlanKeys)},
    )


def _runs(entry: _Run) -> Iterator[PlanRun]:
    """Yield the runs of an entry: one, or one for each member of an ensemble, which share its weight."""
    assert entry.run is not None  # checked by `_faults`
    keys = {each.name: getattr(entry, each.name) for each in dataclasses.fields(RunKeys)}
    plain = PlanRun(**keys | {"name": _name(entry), "run": entry.run})
    if not entry.members:
        yield plain
        return
    chosen = members.chosen(entry.run, entry.members)
    for member, name in zip(chosen, _names(entry), strict=True):
        yield dataclasses.replace(
            plain,
            run=members.folder(entry.run, member),
            name=name,
            weight=plain.weight / len(chosen),
            ensemble=entry.run,
            member=member,
        )


def _name(found: _Run) -> str:
    return found.name or (found.run.absolute().stem if found.run else "")


def _names(found: _Run) -> list[str]:
    """Return the names of the runs of an entry."""
    if not found.members or found.run is None or members.fault(found.run, found.members):
        return [_name(found)]
    return [f"{_name(found)}-{member}" for member in members.chosen(found.run, found.members)]


def _faults(content: _File) -> Iterator[tuple[Where, str]]:
    """Yield place and message of each error across keys."""
    if not content.runs:
        yield ("runs",), f'there are no [[runs]]; add one with place = "NAME" and run = "FOLDER"; {_EXAMPLE}'
    for number, run in enumerate(content.runs):
        here: Where = ("runs", number)
        if not run.place.strip():
            yield here, "runs.place is missing; name the place, as splits keep places apart"
        if run.run is None:
            yield here, "runs.run is missing; name a run folder or a scene file"
        elif not run.run.exists():
            yield (*here, "run"), f"runs.run: there is no {run.run}; check the path"
        elif reason := members.fault(run.run, run.members):
            yield (*here, "members" if run.members else "run"), f"runs.run: {reason}"
        elif fault := next(filter(None, map(file_name, _names(run))), None):
            yield (*here, "name" if run.name else "run"), f"runs.name {fault}; set another name"
    named = [(number, name) for number, run in enumerate(content.runs) for name in _names(run)]
    if (second := twice([name for _, name in named])) is not None:
        number, name = named[second]
        yield ("runs", number), f'two runs are called "{name}"; give one another name'
    splits: dict[str, str] = {}
    for number, run in enumerate(content.runs):
        group = run.place if content.split_by != "run" else _name(run)
        if splits.setdefault(group, run.split) != run.split:
            yield ("runs", number, "split"), f'"{group}" has two splits; give all of its runs the same split'
    for section in ("cameras", "splits") + (("negatives",) if content.positives < 1.0 else ()):
        if not any(dataclasses.asdict(getattr(content, section)).values()):
            yield (section,), f"all shares of [{section}] are 0; give one a share"


def _distribution(reader: TableReader, name: str, value: Any) -> Distribution:
    """Convert an entry of [draws]: a number, or a table with the key `kind`."""
    here: Where = ("draws", name)
    if name not in VALUES:
        remedy = suggestion(name, VALUES) or f"; known here: {', '.join(VALUES)}"
        raise reader.error(here, f'unknown value "{name}" in [draws]{remedy}')
    if not isinstance(value, dict):
        found: Distribution = Constant(reader.value(float, value, here))
    else:
        found = _table(reader, value, here)
    if reason := distributions.fault(found, VALUES[name]):
        raise reader.error(here, f"draws.{name} {reason}")
    return found


def _table(reader: TableReader, value: dict[str, Any], here: Where) -> Distribution:
    kind = value.get("kind", "")
    if kind not in KINDS:
        hint = suggestion(kind, KINDS)
        raise reader.error((*here, "kind"), f"draws.{here[1]}: kind must be {either(KINDS)}{hint}")
    known = {each.name: each for each in dataclasses.fields(KINDS[kind])}
    for name in value:
        if name not in known and name != "kind":
            raise reader.error((*here, name), f'a {kind} has no "{name}"; it has {", ".join(known)}')
    for name, each in known.items():
        if name not in value and each.default is dataclasses.MISSING:
            raise reader.error(here, f"draws.{here[1]}: a {kind} needs {name}")
    kinds: dict[str, Any] = {"values": tuple[float, ...], "weights": tuple[float, ...]}
    given = {name: each for name, each in value.items() if name != "kind"}
    return KINDS[kind](
        **{name: reader.value(kinds.get(name, float), each, (*here, name)) for name, each in given.items()}
    )
