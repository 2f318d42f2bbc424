"""Manifest of an ensemble: ``ensemble.toml``, which also lists runs that are to become members."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NoReturn

from ...errors import InputError, input_error, reading
from ...files import check_text_size
from ...run.models.model import LONGEST
from ...run.models.write import toml_text

MANIFEST = "ensemble.toml"
MOST = 10_000  # members

KINDS = {
    "forecast": "simulations of one fire from one issue time",
    "scenarios": "named cases, such as best and worst",
    "ranked": "simulations that stand for ranks of fire size",
    "ignitions": "simulations of fires with different ignitions",
}
"""Kinds of ensembles, by the relation of their members. Only shares of a `forecast` are a probability of
burning by a time: in other kinds, shares depend on the choice of the members."""

_HEAD = {
    *("name", "kind", "model", "issued", "horizon_s", "perturbed", "not_perturbed", "synthetic", "zone"),
    "source",
}
_MEMBER = {"name", "run", "weight", "end_s"}
_LEFT_OUT = {"name", "reason"}


@dataclass(frozen=True)
class Member:
    """One simulation of a forecast.

    Attributes
    ----------
    name
        Name of the member: ``07``.
    weight
        Weight in shares and quantiles, above 0.
    end
        End of its simulation, s since the issue time: it says nothing of later times.
    run
        Its run folder; None without one.
    """

    name: str
    weight: float = 1.0
    end: float = math.inf
    run: Path | None = None


@dataclass(frozen=True)
class LeftOut:
    """Member that failed, is empty or cannot be read: its name and the reason."""

    name: str
    reason: str


@dataclass(frozen=True)
class Manifest:
    """Content of ``ensemble.toml``.

    Attributes
    ----------
    name, model
        Names of the ensemble and of the fire model.
    issued
        Issue time: arrival times count from it.
    horizon
        Length of the forecast, s; 0 in a list of runs: the longest member's end.
    members, left_out
        Members with and without arrival times.
    perturbed, not_perturbed
        Differing and common inputs of the members, in a sentence each.
    synthetic
        The members are invented.
    zone
        Time zone for people; "": by longitude.
    source
        Files and format of the members.
    kind
        Key of `KINDS`.
    """

    name: str
    model: str
    issued: datetime | None
    horizon: float
    members: tuple[Member, ...]
    left_out: tuple[LeftOut, ...] = ()
    perturbed: str = ""
    not_perturbed: str = ""
    synthetic: bool = False
    zone: str = ""
    source: str = ""
    kind: str = "forecast"


def read(path: Path) -> Manifest:
    """Read a manifest.

    Raises
    ------
    InputError
        The file is missing or damaged, or a value is out of range.
    """
    with reading(path, "TOML file"):
        check_text_size(path)
        text = path.read_text(encoding="utf-8-sig")
        try:
            data = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise _syntax(path, str(error)) from None
    table = _Table(path, data, "")
    table.only(_HEAD | {"member", "left_out"})
    members = [_member(each) for each in table.tables("member")]
    if not 1 <= len(members) <= MOST:
        raise input_error(path, f"has {len(members):,} members; list 1 to {MOST:,} as [[member]]")
    names = [member.name for member in members]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise input_error(path, f'two members have the name "{twice}"; give each its own')
    left_out = table.tables("left_out")
    for each in left_out:
        each.only(_LEFT_OUT)
    return Manifest(
        name=table.text("name") or path.absolute().parent.name,
        model=table.text("model"),
        issued=_issued(table),
        horizon=table.number("horizon_s", 0.0, 0.0, LONGEST),
        members=tuple(members),
        left_out=tuple(LeftOut(each.text("name"), each.text("reason")) for each in left_out),
        perturbed=table.text("perturbed"),
        not_perturbed=table.text("not_perturbed"),
        synthetic=table.flag("synthetic"),
        zone=table.text("zone"),
        source=table.text("source"),
        kind=table.choice("kind", KINDS, "forecast"),
    )


def text(manifest: Manifest) -> str:
    """Format a manifest as TOML."""
    head = {
        "name": manifest.name,
        "kind": manifest.kind,
        "model": manifest.model,
        "perturbed": manifest.perturbed,
        "not_perturbed": manifest.not_perturbed,
        "zone": manifest.zone,
        "source": manifest.source,
    }
    lines = [f"{key} = {toml_text(value)}" for key, value in head.items() if value]
    if manifest.issued:
        lines.append(f"issued = {manifest.issued.astimezone(UTC):%Y-%m-%dT%H:%M:%S.%f}Z")
    lines.append(f"horizon_s = {float(manifest.horizon)!r}")
    if manifest.synthetic:
        lines.append("synthetic = true")
    for member in manifest.members:
        lines += ["", "[[member]]", f"name = {toml_text(member.name)}", f"weight = {float(member.weight)!r}"]
        if math.isfinite(member.end):
            lines.append(f"end_s = {float(member.end)!r}")
        if member.run is not None:
            lines.append(f"run = {toml_text(member.run.as_posix())}")
    for each in manifest.left_out:
        lines += ["", "[[left_out]]", f"name = {toml_text(each.name)}", f"reason = {toml_text(each.reason)}"]
    return "\n".join(lines) + "\n"


class _Table:
    """Table of a manifest, and checked access to its values; `place` begins each message."""

    def __init__(self, path: Path, data: Any, place: str) -> None:
        if not isinstance(data, dict):
            raise input_error(path, f"{place}is not a table; write [[{place.split()[0]}]]")
        self.path, self.data, self.place = path, data, place

    def only(self, known: set[str]) -> None:
        """Check that all keys are known."""
        if unknown := sorted(set(self.data) - known):
            self._wrong(f'has an unknown key "{unknown[0]}"; known are {", ".join(sorted(known))}')

    def text(self, key: str) -> str:
        """Return a text, by default ""."""
        value = self.data.get(key, "")
        if not isinstance(value, str):
            self._wrong(f"{key} is not a text; write it in quotes")
        return " ".join(value.split())

    def choice(self, key: str, known: Iterable[str], default: str) -> str:
        """Return one of the known words."""
        value = self.text(key) or default
        if value not in known:
            self._wrong(f'{key} is "{value}"; write one of {", ".join(known)}')
        return value

    def flag(self, key: str) -> bool:
        """Return true or false, by default False."""
        value = self.data.get(key, False)
        if not isinstance(value, bool):
            self._wrong(f"{key} is not true or false")
        return value

    def number(self, key: str, default: float, low: float, high: float) -> float:
        """Return a number between bounds."""
        value = self.data.get(key)
        if value is None:
            return default
        if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
            self._wrong(f"{key} is not a number from {low:g} to {high:g}")
        return float(value)

    def tables(self, key: str) -> list[_Table]:
        """Return a list of tables, by default empty."""
        value = self.data.get(key, [])
        if not isinstance(value, list):
            self._wrong(f"{key} is not a list of tables; write [[{key}]]")
        return [_Table(self.path, each, f"{key} {index}: ") for index, each in enumerate(value, 1)]

    def _wrong(self, reason: str) -> NoReturn:
        raise input_error(self.path, self.place + reason)


def _member(table: _Table) -> Member:
    table.only(_MEMBER)
    name, folder = table.text("name"), table.data.get("run")
    if folder is not None and not (isinstance(folder, str) and folder):
        raise input_error(table.path, f"{table.place}run is not a folder; write its path in quotes")
    if not (name or folder):
        raise input_error(table.path, f"{table.place}has neither a name nor a run; give one")
    return Member(
        name=name or Path(str(folder)).name,
        weight=table.number("weight", 1.0, 1e-9, 1e9),
        end=table.number("end_s", math.inf, 0.0, LONGEST),
        run=None if folder is None else Path(folder),
    )


def _issued(table: _Table) -> datetime | None:
    value = table.data.get("issued")
    if value is None:
        return None
    if not isinstance(value, datetime) or value.tzinfo is None:
        reason = "issued is not a time with an offset from UTC, such as 2014-09-17T12:00:00-07:00"
        raise input_error(table.path, reason)
    return value


def _syntax(path: Path, message: str) -> InputError:
    """Move the place of a TOML error from the end of its message to the front."""
    found = re.search(r" \(at line (\d+), column (\d+)\)$", message)
    if found is None:
        return input_error(path, f"is not TOML: {message}; correct it")
    line, column = int(found[1]), int(found[2])
    return input_error(path, f"is not TOML: {message[: found.start()]}; correct it", line=line, column=column)
