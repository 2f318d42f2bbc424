"""`firetwin bench`: run time and error against alternatives."""

from __future__ import annotations

import argparse
import json

from .. import argument_types as types
from ..command import MACHINE, Command
from ..progress import Reporter, result, say

_DETAIL = """\
Measures twelve steps and their alternatives in turn on this machine: median and range of at least five
repetitions. Takes about three CPU minutes. --runs 3 shows the variation between runs.
Alternatives that are not installed are listed and skipped (pip install 'firetwin[bench]' installs them).
The exit status is 1 if a target is missed."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument(
        "--runs",
        metavar="N",
        type=types.count,
        default=1,
        help="number of repeated benchmarks, for ranges (1)",
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="write JSON")
    form.add_argument("--markdown", action="store_true", help="write Markdown tables")


def _run(arguments: argparse.Namespace) -> int:
    """Measure, and print the tables; the exit status is 1 if a target is missed."""
    from . import measure

    say("measuring run time and error of all tools in turn")
    from . import table

    report = measure(arguments.runs, Reporter())
    if arguments.json:
        result(json.dumps(report.as_json(), indent=1))
    else:
        result(table.markdown(report) if arguments.markdown else table.page(report))
    missed = sum(not target.met for target in report.targets)
    say(f"{len(report.targets) - missed} of {len(report.targets)} targets met")
    return 1 if missed else 0


COMMAND = Command("bench", "benchmark run time and error against alternatives", _DETAIL, MACHINE, _run, _add)
