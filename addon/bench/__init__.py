"""``firetwin bench``: run time against error of every step, with its rivals measured in the same run.

A subject is a module: the first line of its docstring says what is compared, and ``run(bench)`` adds rows
(`Bench.race` lets the tools take turns) and targets.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .harness import Report

SUBJECTS = (
    "text",
    "geodesy",
    "forest",
    "stand",
    "ground",
    "skip",
    "emitters",
    "volume",
    "smoke",
    "step",
    "march",
    "scrub",
    "scattering",
    "plume",
    "flow",
    "interpolation",
    "frames",
    "particles",
    "facts",
    "planning",
    "radiometry",
)
"""In the order of the report."""


def measure(full: bool = False, runs: int = 1, progress: Any = None) -> Report:
    """Run every subject `runs` times; `progress(done, total, what)` is called before each and at the end.

    Several runs tell what a single one cannot: how much the figures differ from minute to minute.
    """
    from .harness import Bench

    bench = Bench(full, runs=runs)
    wanted = SUBJECTS * runs
    for done, name in enumerate(wanted):
        if progress:
            progress(done, len(wanted), "measuring")
        subject = import_module(f".{name}", __package__)
        bench.begin(name, subject.__doc__.partition("\n")[0])
        subject.run(bench)
    if progress:
        progress(len(wanted), len(wanted), "measuring")
    return bench.report()
