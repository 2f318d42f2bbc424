"""Benchmark harness: rows (one tool on one case), targets, and skipped measurements with reasons."""

from __future__ import annotations

import importlib
import importlib.util
import os
import platform
import statistics
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from types import ModuleType
from typing import Any

import firetwin_core as core

from .. import extras
from .timing import MOST, SECONDS, Runner, Times, label, race

OURS = "firetwin"
ORIGIN = (38.93, -120.55, 0.0)
"""Latitude, longitude (degrees) and height (m) of the local frame in all subjects."""


@dataclass(frozen=True)
class Row:
    """One tool on one case: the wall-clock time of each repetition (s) for `items` items, and its error.

    Unknown values are empty (`times`) or None (`error`).
    """

    subject: str
    case: str
    tool: str
    times: tuple[float, ...]
    items: int
    unit: str
    error: float | None = None
    error_unit: str = ""
    threads: int = 1

    @property
    def seconds(self) -> float | None:
        """Median wall-clock time, s."""
        return statistics.median(self.times) if self.times else None

    @property
    def label(self) -> str:
        """``firetwin, 2 threads``."""
        return label(self.tool, self.threads)


@dataclass(frozen=True)
class Target:
    """A target and its values: one for each repetition, or a single one if it is deterministic.

    `quantity` names the measured quantity. The median must be at most the bound if `most` is set, else at
    least. If `rival` is set, the bound was measured with that tool.
    """

    subject: str
    quantity: str
    values: tuple[float, ...]
    bound: float
    unit: str
    most: bool = False
    rival: str = ""

    @property
    def value(self) -> float:
        """The median."""
        return statistics.median(self.values)

    @property
    def met(self) -> bool:
        """True if the median is within the bound."""
        return self.value <= self.bound if self.most else self.value >= self.bound


@dataclass
class Bench:
    """Measurements of subjects."""

    subject: str = ""
    machine: dict[str, Any] = field(default_factory=lambda: _machine())
    subjects: dict[str, str] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)
    targets: list[Target] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)

    def begin(self, subject: str, what: str) -> None:
        """Begin the next subject; `what` describes its comparison in one sentence."""
        self.subject = subject
        self.subjects[subject] = what

    def race(
        self, case: str, runners: Sequence[Runner], items: int, unit: str, error_unit: str = ""
    ) -> dict[str, Times]:
        """Time the tools in turns, add a row for each, and return the times by label."""
        measured = race(runners, MOST, SECONDS)
        for runner, times in zip(runners, measured, strict=True):
            error, threads = runner.error, runner.threads
            self.row(
                case, runner.tool, times, items, unit, error=error, error_unit=error_unit, threads=threads
            )
        return {runner.label: times for runner, times in zip(runners, measured, strict=True)}

    def row(
        self,
        case: str,
        tool: str,
        times: Times | None,
        items: int,
        unit: str,
        *,
        error: float | None = None,
        error_unit: str = "",
        threads: int = 1,
    ) -> None:
        """Add a measurement; `error` is in `error_unit`."""
        seconds = times.seconds if times else ()
        error = None if error is None else float(error)
        self.rows.append(Row(self.subject, case, tool, seconds, items, unit, error, error_unit, threads))

    def target(
        self,
        quantity: str,
        values: float | Sequence[float],
        bound: float,
        unit: str,
        *,
        most: bool = False,
        rival: str = "",
    ) -> None:
        """Add a target with its measured value, or with one value for each repetition."""
        several = tuple(map(float, values)) if isinstance(values, Sequence) else (float(values),)
        self.targets.append(Target(self.subject, quantity, several, float(bound), unit, most, rival))

    def rival(self, name: str) -> ModuleType | None:
        """Import the package of a competing tool; record a skip if it is missing."""
        try:
            return importlib.import_module(name)
        except ImportError as error:
            missing = isinstance(error, ModuleNotFoundError) and error.name == name
            why = f"is not installed ({extras.install('bench')})" if missing else "cannot be imported"
            self.skip(f"{name} {why}")
            return None

    def blender(self) -> bool:
        """Check that Blender's module is installed; record a skip if it is missing."""
        if there := importlib.util.find_spec("bpy") is not None:
            return there
        self.skip("bpy is not installed (pip install 'firetwin[blender]')")
        return False

    def flip(self) -> ModuleType | None:
        """Import the FLIP metric for pictures rendered by Blender, if both are installed."""
        return self.rival("flip_evaluator") if self.blender() else None

    def skip(self, reason: str) -> None:
        """Record a skipped measurement."""
        line = f"{self.subject}: {reason}"
        if line not in self.skipped:
            self.skipped.append(line)

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return {
            "machine": self.machine,
            "subjects": self.subjects,
            "rows": [asdict(row) | {"seconds": row.seconds} for row in self.rows],
            "targets": [
                asdict(target) | {"value": target.value, "met": target.met} for target in self.targets
            ],
            "skipped": self.skipped,
        }


def _machine() -> dict[str, Any]:
    import numpy

    versions = {"firetwin_core": core.__version__, "numpy": numpy.__version__}
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "load": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None,
        "system": platform.platform(),
        "python": platform.python_version(),
    } | {"versions": versions | dict(core.build_info())}


def _processor() -> str:
    try:
        with open("/proc/cpuinfo") as file:
            names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
        return names[0]
    except (OSError, IndexError):
        return platform.processor() or platform.machine()
