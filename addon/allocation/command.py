"""`firetwin allocate`: a suggested allocation. Exercise: not operational advice."""

from __future__ import annotations

import argparse
import math
import textwrap
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .. import argument_types as types
from .. import limits
from ..command import SCENES, Command, add_overwrite, amend
from ..stations.records import EXERCISE
from . import INDIRECT, LIMITS, RADIUS

if TYPE_CHECKING:
    from firetwin_core.run import Run

_LIMITS = textwrap.fill(f"Limits: {'; '.join(LIMITS)}.", 110)

_DETAIL = f"""\
{EXERCISE}.

Suggests an allocation of the resources of a station file to divisions of a run's front. They build at least
as much line as the length of the front at the hour of containment, at minimum cost and loss (after Donovan
and Rideout 2003). The line closes gaps and bays of the front (--close-gaps) and runs outside its edge
(--indirect). The result names each division that cannot be held, with the nearest feasible plan. Divisions
are sectors around the centre of the burned area, lettered clockwise from north.

  firetwin allocate stations.gpkg RUN --budget 250000 --standard-response engine/3=4,dozer/2=1 --minutes 60

{_LIMITS}

Needs SciPy (pip install 'firetwin[resources]'). The exit status is 1 if an allocation is impossible; the
reasons are printed on stderr."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("stations", metavar="STATIONS.gpkg", type=types.path, help="station file")
    parser.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    parser.add_argument(
        "--divisions", metavar="N", type=types.count, default=4, help="number of divisions, up to 26 (4)"
    )
    parser.add_argument(
        "--from",
        dest="start",
        metavar="TIME",
        type=types.moment,
        help="time of the order, such as 2014-09-17T16:00-07:00 (the ignition)",
    )
    parser.add_argument(
        "--hours",
        metavar="N",
        type=types.count,
        help="hours after the order (12, or until the end of the run)",
    )
    parser.add_argument(
        "--budget", metavar="X", type=_amount, help="maximum cost of all resources (no limit)"
    )
    parser.add_argument(
        "--standard-response",
        dest="response",
        metavar="TYPE=N,...",
        type=parse_response,
        default={},
        help="minimum number by type or kind that arrives in time, such as engine/3=4,dozer=1 (none)",
    )
    parser.add_argument(
        "--minutes",
        metavar="MIN",
        type=_amount,
        default=60.0,
        help="time limit of the standard response, min (60)",
    )
    parser.add_argument(
        "--loss-hectare", metavar="X", type=_amount, default=0.0, help="loss per burned hectare (0)"
    )
    parser.add_argument(
        "--escape-loss",
        metavar="X",
        type=_amount,
        default=math.inf,
        help="loss of a division that is not contained (more than the cost of all resources)",
    )
    parser.add_argument("--contain-all", action="store_true", help="fail if a division cannot be contained")
    parser.add_argument(
        "--close-gaps",
        metavar="M",
        type=_amount,
        default=2.0 * RADIUS,
        help=f"width up to which the line closes gaps and bays of the front, m ({2.0 * RADIUS:g}; 0: none)",
    )
    parser.add_argument(
        "--indirect",
        metavar="M",
        type=_amount,
        default=INDIRECT,
        help=f"distance of the line from the fire's edge, m ({INDIRECT:g})",
    )
    parser.add_argument(
        "--geojson", metavar="FILE", type=types.path, help="also write lines and resources for maps"
    )
    parser.add_argument("--json", action="store_true", help="write JSON")
    add_overwrite(parser)


def parse_response(text: str) -> dict[str, int]:
    """Parse numbers by type, such as "engine/3=4,dozer/2=1"."""
    numbers: dict[str, int] = {}
    for part in text.split(","):
        kind, _, number = (word.strip() for word in part.partition("="))
        if not kind or not number.isdecimal() or int(number) < 1:
            raise argparse.ArgumentTypeError(f"must have the form engine/3=4,dozer/2=1, not {text!r}")
        if kind in numbers:
            raise argparse.ArgumentTypeError(f"names {kind} twice")
        numbers[kind] = int(number)
    return numbers


def _amount(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not limits.is_quantity(value):
        most = f"{limits.LARGEST_NUMBER:,.0f}"
        raise argparse.ArgumentTypeError(f"must be a number of at least 0 and at most {most}, not {text!r}")
    return value


@dataclass(frozen=True)
class Suggested:
    """A suggestion (see `suggestion.describe`) for a run, its map layer, and further lines by division."""

    run: Run
    suggestion: dict[str, Any]
    drawn: dict[str, Any]
    lines: dict[str, list[str]] = field(default_factory=dict)


def _run(arguments: argparse.Namespace) -> None:
    """Print the suggested allocation.

    Raises
    ------
    Error
        The allocation is infeasible; the message gives the reasons.
    """
    import json

    from .. import output
    from ..errors import Error
    from ..progress import result
    from ..run import readers, times
    from . import job, page, read
    from .control_line import LineOptions
    from .problem import Request

    if arguments.geojson is not None:
        output.check(arguments.geojson, arguments.overwrite)
    run = readers.open(arguments.run)
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
    suggestion = job.suggest(units, run, request, start, arguments.hours, arguments.divisions, line=line)
    drawn = suggestion.pop("map")
    lines = amend(arguments, Suggested(run, suggestion, drawn)).lines
    suggestion["left_out"] += left_out
    if arguments.geojson is not None:
        text = json.dumps(drawn, separators=(",", ":")) + "\n"
        output.write_text(arguments.geojson, text, arguments.overwrite)
    result(json.dumps(suggestion, indent=1) if arguments.json else page.format_text(suggestion, lines))
    if suggestion["reasons"]:
        raise Error("; ".join(suggestion["reasons"]))


COMMAND = Command("allocate", "suggest an allocation of resources (exercise)", _DETAIL, SCENES, _run, _add)
