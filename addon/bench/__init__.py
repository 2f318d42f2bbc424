"""Benchmarks of ``firetwin bench``: run time and error of the steps that users wait for.

A subject is a module: the first line of its docstring describes the comparison, and ``run(bench)`` adds rows
(`Bench.race` runs the tools in turns) and targets. Benchmarks for developers are in ``tests/benchmarks``.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING

from ..progress import Progress, silent

if TYPE_CHECKING:
    from .harness import Bench

SUBJECTS = tuple(f"{__name__}.{name}" for name in ("text", "forest", "cull", "flow", "march", "radiometry"))
"""Modules of the subjects, in the order of the report."""


def measure(modules: Sequence[str] = SUBJECTS, progress: Progress = silent) -> Bench:
    """Run each module's subject."""
    from .harness import Bench

    bench = Bench()
    for done, name in enumerate(modules):
        progress(done, len(modules), "measuring")
        subject = import_module(name)
        bench.begin(name.rpartition(".")[2], (subject.__doc__ or "").partition("\n")[0])
        subject.run(bench)
    progress(len(modules), len(modules), "measuring")
    return bench
