"""The command `firetwin allocate`. Exercise: not operational advice."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path

from firetwin_core.run import Run

from .. import files
from ..errors import Error
from ..progress import result
from ..run import times
from ..run.ensemble import place_arrivals
from . import job, members, page, read
from .control_line import LineOptions
from .problem import Request


def run(arguments: argparse.Namespace, open_run: Callable[[Path], Run]) -> None:
    """Print the suggested allocation.

    Raises
    ------
    Error
        The allocation is infeasible; the message gives the reasons.
    """
    run = open_run(arguments.run)
    start = arguments.start or times.utc(run, job.default_order_time(run))
    units, left_out = read.read(arguments.stations, start)
    request = Request(
        arguments.budget,
        arguments.response,
        arguments.minutes,
        arguments.loss_hectare,
        None if arguments.contain_all else arguments.escape_loss,
    )
    line = LineOptions(0.5 * arguments.close_gaps, arguments.indirect)
    found = job.suggest(units, run, request, start, arguments.hours, arguments.divisions, line=line)
    drawn = found.pop("map")
    if arguments.ensemble is not None:
        members.add(found, run, place_arrivals.open_forecast(arguments.ensemble, "the list"), drawn)
    found["left_out"] += left_out
    if arguments.geojson is not None:
        files.write_text(arguments.geojson, json.dumps(drawn, separators=(",", ":")) + "\n")
    result(json.dumps(found, indent=1) if arguments.json else page.format_text(found))
    if found["reasons"]:
        raise Error("; ".join(found["reasons"]))
