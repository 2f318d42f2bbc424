"""`firetwin sample`: the synthetic sample run."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import RUNS, Command, add_overwrite
from ..progress import Reporter, result, say

_DETAIL = """\
No output of a fire-atmosphere model for the King Fire is public. This run is synthetic: terrain, fuels and
spread follow publications about the fire. All its output is labelled as synthetic."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("out", metavar="OUT", type=types.path, help="output folder; created if missing")
    parser.add_argument(
        "--frames", metavar="N", type=types.count, help="number of model times, evenly spread (all)"
    )
    parser.add_argument(
        "--format", choices=("npy", "text"), default="npy", help="format of field files (npy)"
    )
    parser.add_argument(
        "--pace",
        metavar="FACTOR",
        type=types.factor,
        default=1.0,
        help="factor of the rate of spread, for a what-if run (1)",
    )
    parser.add_argument(
        "--member", metavar="I", type=types.member, default=0, help="write the run of member I (0)"
    )
    parser.add_argument(
        "--early",
        action="store_true",
        help="write the first 6 hours of the fire, from its ignition on 13 September, with invented spread",
    )
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write the sample run."""
    from ..data import sample

    say(f"writing the synthetic King-like run to {arguments.out}")
    report = Reporter("model times")
    options = arguments.frames, arguments.format, report, arguments.pace, arguments.member
    sample.write(arguments.out, *options, overwrite=arguments.overwrite, early=arguments.early)
    result(arguments.out)


COMMAND = Command("sample", "write the synthetic King-like sample run", _DETAIL, RUNS, _run, _add)
