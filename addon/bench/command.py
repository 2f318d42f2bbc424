"""`firetwin bench`: run time and error against alternatives."""

from __future__ import annotations

import argparse
import json

from ..command import MACHINE, Command
from ..progress import Reporter, result, say

_DETAIL = """\
Measures the steps of the table in README.md and their alternatives in turn on this machine: median and range
of at least five repetitions. Takes about three CPU minutes. Alternatives that are not installed are listed
and skipped (pip install 'firetwin[bench]' installs them). The exit status is 1 if a target is missed."""
_FORMER = {
    "runs": "run the command several times",
    "markdown": "omit it, as the targets are a Markdown table",
}


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("--json", action="store_true", help="write JSON")
    for name in _FORMER:
        parser.add_argument(f"--{name}", nargs="?", const="", help=argparse.SUPPRESS)


def _run(arguments: argparse.Namespace) -> int:
    """Measure, and print the tables; the exit status is 1 if a target is missed.

    Raises
    ------
    UsageError
        An option of former versions was given.
    """
    from ..errors import UsageError
    from . import measure, table

    for name, remedy in _FORMER.items():
        if getattr(arguments, name) is not None:
            raise UsageError(f"--{name}: bench no longer has it; {remedy}")
    say("measuring run time and error of all tools in turn")
    bench = measure(progress=Reporter())
    result(json.dumps(bench.as_json(), indent=1) if arguments.json else table.page(bench))
    missed = sum(not target.met for target in bench.targets)
    say(f"{len(bench.targets) - missed} of {len(bench.targets)} targets met")
    return 1 if missed else 0


COMMAND = Command("bench", "benchmark run time and error against alternatives", _DETAIL, MACHINE, _run, _add)
