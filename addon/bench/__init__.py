"""``firetwin bench``: run time against error of every step, with its rivals measured in the same run."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .harness import Bench, Report

SUBJECTS = (
    "text",
    "geodesy",
    "forest",
    "emitters",
    "volume",
    "smoke",
    "step",
    "plume",
    "interpolation",
    "particles",
)
"""One module each, with ``run(bench)``, in the order of the report."""


def measure(full: bool = False, progress: Any = None) -> Report:
    """Run every subject; `progress(done, total, what)` is called before each and at the end."""
    bench = Bench(full)
    for done, name in enumerate(SUBJECTS):
        if progress:
            progress(done, len(SUBJECTS), "measuring")
        bench.subject = name
        import_module(f".{name}", __package__).run(bench)
    if progress:
        progress(len(SUBJECTS), len(SUBJECTS), "measuring")
    return bench.report()
