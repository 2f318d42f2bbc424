"""Verbs of `firetwin dataset`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from ..progress import Reporter, count, result, say
from ..shot.schema.frame_list import FrameList
from . import check, draw_labels, finish, formats, members, plan_file, produce, sample_job
from .draws import count_rejects
from .plan import SPLITS
from .produce import Production
from .splits import Splits


def run(arguments: argparse.Namespace) -> int:
    """Run the requested verb; returns the exit status."""
    if arguments.verb == "check":
        return _check(arguments.folder)
    if arguments.verb == "draw":
        drawn = draw_labels.write(arguments.folder, arguments.only, arguments.out, arguments.overwrite)
        for path in drawn:
            result(path)
        return 0
    names = formats.names(arguments.format)
    if arguments.verb == "formats":
        finish_set(arguments.folder, names, arguments.overwrite)
        return 0
    production = prepare(arguments.plan, arguments.out, arguments.only)
    if arguments.estimate and arguments.json:
        result(json.dumps(_facts(production), indent=1))
        return 0
    lines = production.estimate().lines() + describe(production)
    if arguments.estimate:
        result("\n".join(lines))
        return 0
    for line in lines:
        say(line)
    make(production, arguments.overwrite)
    if arguments.only:
        result(arguments.out)
        return 0
    finish_set(arguments.out, names, arguments.overwrite)
    return 0


def prepare(path: Path, out: Path, only: str = "") -> Production:
    """Read a plan, convert the members of its ensembles, and draw its first samples."""
    plan = plan_file.read(path)
    if any(run.ensemble for run in plan.runs):
        with produce.alone(out, "members"):
            members.convert(plan, Reporter("converting"), say)
    return produce.prepare(plan, out, only, Reporter())


def make(production: Production, overwrite: bool = False) -> None:
    """Make the missing samples of a production, and show the progress."""
    reporter = Reporter(produce.SAMPLES)
    try:
        produce.run(production, sample_job.make, reporter, say, overwrite)
    finally:
        reporter.close()


def describe(production: Production) -> list[str]:
    """Describe the draws of the first block of a production: splits, and cameras that were rejected."""
    block = production.blocks[0]
    draws = [each for visit in production.visits(block) for each in visit.draws]
    by = Splits(production.plan).by
    numbers = [sum(each.split == name for each in draws) for name in SPLITS]
    parts = ", ".join(f"{name} {number:,}" for name, number in zip(SPLITS, numbers, strict=True) if number)
    part = "" if len(block) == production.plan.count else f" of samples {block[0]:,} to {block[-1]:,}"
    lines = [f"splits{part} by {by}: {parts}"]
    if by == "camera":
        lines.append("all splits show the same fires, as there are fewer places and runs than splits")
    if rejects := count_rejects(draws):
        reasons = ", ".join(f"{reason} {number:,}" for reason, number in rejects.items())
        lines.append(f"{count(sum(rejects.values()), 'camera')} rejected and drawn again: {reasons}")
    return lines


def _facts(production: Production) -> dict[str, Any]:
    """Collect the estimate for other programs; samples of one scene are made together.

    All blocks with requested samples are drawn.
    """
    estimate = production.estimate()
    visits = [visit for block in production.blocks for visit in production.visits(block)]
    draws = [each for visit in visits for each in visit.draws]
    return {
        "count": production.plan.count,
        "missing": estimate.samples,
        "seconds": round(estimate.seconds),
        "bytes": round(estimate.bytes),
        "scenes": [FrameList.of(each.index for each in visit.draws) for visit in visits],
        "rejects": count_rejects(draws),
        "splits": {each.index: each.split for each in sorted(draws, key=lambda drawn: drawn.index)},
    }


def _check(folder: Path) -> int:
    """Print the findings of a data set; returns 1 if it has faults."""
    reporter, faults = Reporter("checking samples"), 0
    for finding in check.check(folder, reporter):
        result(f"{'' if finding.is_fault else 'note: '}{finding.text}")
        faults += finding.is_fault
    reporter.close()
    say("no faults" if not faults else count(faults, "fault"))
    return 1 if faults else 0


def finish_set(out: Path, names: tuple[str, ...], overwrite: bool = False) -> None:
    """Write formats, card, report and hashes of a data set; one process at a time."""
    with produce.alone(out, "finish"):
        produce.remove_parts(out)
        for path in finish.write(out, names, say, overwrite):
            result(path)
