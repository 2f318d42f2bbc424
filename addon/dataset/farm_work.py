"""Data sets on a farm: tasks make samples, and the last stage writes formats and report."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from pathlib import Path

from ..errors import InputError
from ..files import read_text
from ..progress import say
from . import truth
from .command import FORMATS

FOLDER, UNIT, KIND = "dataset", "sample", "labels"


def sniff(path: Path) -> bool:
    """Return whether a file is the plan of a data set: its runs have places."""
    try:
        runs = tomllib.loads(read_text(path, "utf-8-sig")).get("runs")
    except (OSError, ValueError, RecursionError, InputError):
        return False
    return isinstance(runs, list) and any(isinstance(run, dict) and "place" in run for run in runs)


def split(plan: Path, out: Path) -> tuple[int, list[list[int]]]:
    """Return the number of samples, and the samples of each scene, which are made together."""
    from . import verbs

    production = verbs.prepare(plan, out / FOLDER)
    for line in (*production.estimate().lines(), *verbs.describe(production)):
        say(line)
    visits = (visit for block in production.blocks for visit in production.visits(block))
    return production.plan.count, [[each.index for each in visit.draws] for visit in visits]


def make(plan: Path, out: Path, samples: str) -> None:
    """Make the missing ones of these samples."""
    from . import verbs

    verbs.make(verbs.prepare(plan, out / FOLDER, samples))


def missing(out: Path, samples: Iterable[int]) -> list[int]:
    """List the samples that are not finished."""
    return [index for index in samples if not truth.path(out / FOLDER, index).is_file()]


def finish(plan: Path, out: Path) -> None:
    """Write formats and report of a complete data set."""
    from . import formats, verbs

    verbs.finish_set(out / FOLDER, formats.names(FORMATS))
