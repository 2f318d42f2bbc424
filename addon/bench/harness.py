"""What a benchmark is made of: rows (one tool on one case), targets, and what was left out and why."""

from __future__ import annotations

import importlib
import os
import platform
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from types import ModuleType
from typing import Any

import firetwin_core as core

OURS = "firetwin"


@dataclass(frozen=True)
class Row:
    """One tool on one case: the best time (s) for `items` things, its error (`error_unit`) and what it wrote.

    `error` and `bytes` are None where they are unknown or make no sense.
    """

    subject: str
    case: str
    tool: str
    seconds: float | None
    items: int
    unit: str
    error: float | None = None
    error_unit: str = ""
    threads: int = 1
    bytes: int | None = None


@dataclass(frozen=True)
class Target:
    """A promise and what was measured; `most`: the value may be at most the bound, else at least."""

    subject: str
    promise: str
    value: float
    bound: float
    unit: str
    most: bool = False

    @property
    def met(self) -> bool:
        """Whether the promise is kept."""
        return self.value <= self.bound if self.most else self.value >= self.bound


@dataclass(frozen=True)
class Report:
    """Everything measured."""

    machine: dict[str, Any]
    rows: list[Row]
    targets: list[Target]
    skipped: list[str]

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        targets = [asdict(target) | {"met": target.met} for target in self.targets]
        rows = [asdict(row) for row in self.rows]
        return {"machine": self.machine, "rows": rows, "targets": targets, "skipped": self.skipped}


@dataclass
class Bench:
    """Collects what the subjects measure."""

    full: bool = False
    subject: str = ""
    rows: list[Row] = field(default_factory=list)
    targets: list[Target] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)

    def best(self, call: Callable[[], Any], times: int = 5) -> float:
        """Shortest run time of `call` (s) of `times` runs, or as many as begin within a second.

        The shortest is the one least disturbed by other programs.
        """
        budget, least, spent = (10.0 if self.full else 1.0), float("inf"), 0.0
        for _ in range(times * (5 if self.full else 1)):
            start = time.perf_counter()
            call()
            seconds = time.perf_counter() - start
            least, spent = min(least, seconds), spent + seconds
            if spent > budget:
                break
        return least

    def row(
        self,
        case: str,
        tool: str,
        seconds: float | None,
        items: int,
        unit: str,
        *,
        error: float | None = None,
        error_unit: str = "",
        threads: int = 1,
        bytes: int | None = None,
    ) -> None:
        """Keep a measurement; error is what `error_unit` says."""
        error = None if error is None else float(error)
        row = Row(self.subject, case, tool, seconds, items, unit, error, error_unit, threads, bytes)
        self.rows.append(row)

    def target(self, promise: str, value: float, bound: float, unit: str, most: bool = False) -> None:
        """Keep a promise and its measured value."""
        self.targets.append(Target(self.subject, promise, float(value), bound, unit, most))

    def rival(self, name: str) -> ModuleType | None:
        """Import the package of a rival, or note that it is missing."""
        try:
            return importlib.import_module(name)
        except ImportError as error:
            missing = isinstance(error, ModuleNotFoundError) and error.name == name
            why = "is not installed (pip install 'firetwin[bench]')" if missing else "cannot be imported"
            self.skip(f"{name} {why}")
            return None

    def skip(self, reason: str) -> None:
        """Note what was left out."""
        line = f"{self.subject}: {reason}"
        if line not in self.skipped:
            self.skipped.append(line)

    def report(self) -> Report:
        """Everything measured so far."""
        return Report(_machine(), self.rows, self.targets, self.skipped)


class threads:  # noqa: N801 - reads as a statement
    """``with threads(2):`` limits the worker threads of the core."""

    def __init__(self, number: int) -> None:
        self.number = number

    def __enter__(self) -> None:
        core.set_threads(self.number)

    def __exit__(self, *_: object) -> None:
        core.set_threads(0)


def _machine() -> dict[str, Any]:
    import numpy

    versions = {"firetwin_core": core.__version__, "numpy": numpy.__version__}
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "load": round(os.getloadavg()[0], 1),
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
