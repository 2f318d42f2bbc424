"""Verbs of `firetwin dataset`."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..progress import Reporter, count, result, say
from . import finish, formats, plan_file, produce, sample_job
from .draws import count_rejects
from .plan import SPLITS
from .produce import Production
from .splits import Splits


def run(arguments: argparse.Namespace) -> int:
    """Run the requested verb; returns the exit status."""
    names = formats.names(arguments.format)
    if arguments.verb == "formats":
        _finish(arguments.folder, names)
        return 0
    plan = plan_file.read(arguments.plan)
    production = produce.prepare(plan, arguments.out, arguments.only, Reporter())
    lines = production.estimate().lines() + _describe(production)
    if arguments.estimate:
        result("\n".join(lines))
        return 0
    for line in lines:
        say(line)
    reporter = Reporter(produce.SAMPLES)
    try:
        produce.run(production, sample_job.make, reporter, say)
    finally:
        reporter.close()
    if arguments.only:
        result(arguments.out)
        return 0
    _finish(arguments.out, names)
    return 0


def _describe(production: Production) -> list[str]:
    """Describe the draws of a production: splits, and cameras that were rejected."""
    draws = production.draws
    splits: dict[str, int] = {}
    for each in draws.values():
        splits[each.split] = splits.get(each.split, 0) + 1
    by = Splits(production.plan).by
    parts = ", ".join(f"{name} {splits[name]:,}" for name in SPLITS if name in splits)
    found = [f"splits by {by}: {parts}"]
    if by == "camera":
        found.append("all splits show the same fires, as there are fewer places and runs than splits")
    if rejects := count_rejects(draws):
        reasons = ", ".join(f"{reason} {number:,}" for reason, number in rejects.items())
        found.append(f"{count(sum(rejects.values()), 'camera')} rejected and drawn again: {reasons}")
    return found


def _finish(out: Path, names: tuple[str, ...]) -> None:
    """Write formats, card, report and hashes of a data set; one process at a time."""
    with produce.alone(out, "finish"):
        produce.remove_parts(out)
        for path in finish.write(out, names, say):
            result(path)
