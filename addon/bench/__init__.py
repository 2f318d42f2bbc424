"""Benchmarks of ``firetwin bench``: run time and error of the twelve steps that users wait for.

A subject is a module: the first line of its docstring describes the comparison, and ``run(bench)`` adds rows
(`Bench.race` runs the tools in turns) and targets. Benchmarks for developers are in ``tests/benchmarks``.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING

from ..progress import Progress, silent

if TYPE_CHECKING:
    from .harness import Report

SUBJECTS = (
    "text",
    "emitters",
    "interpolation",
    "forest",
    "ground",
    "cull",
    "smoke",
    "flow",
    "march",
    "motion",
    "radiometry",
    "ensembles",
)
"""Subjects in the order of the report."""


def measure(runs: int = 1, progress: Progress = silent) -> Report:
    """Run every subject of ``firetwin bench``; see `measure_modules`."""
    return measure_modules([f"{__name__}.{name}" for name in SUBJECTS], runs, progress)


def measure_modules(modules: Sequence[str], runs: int = 1, progress: Progress = silent) -> Report:
    """Run each module's subject `runs` times.

    Several runs give the variation of the figures from minute to minute.
    """
    from .harness import Bench

    bench = Bench(runs=runs)
    wanted = [*modules] * runs
    for done, name in enumerate(wanted):
        progress(done, len(wanted), "measuring")
        subject = import_module(name)
        bench.begin(name.rpartition(".")[2], (subject.__doc__ or "").partition("\n")[0])
        subject.run(bench)
    progress(len(wanted), len(wanted), "measuring")
    return bench.report()
