"""Arguments of `firetwin allocate`; no heavy module is imported here."""

from __future__ import annotations

import argparse
import math
import textwrap
from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from .. import limits
from ..stations.records import EXERCISE
from . import INDIRECT, LIMITS, RADIUS

_LIMITS = textwrap.fill(f"Limits: {'; '.join(LIMITS)}.", 110)

DETAIL = f"""\
{EXERCISE}.

Suggests an allocation of the resources of a station file to divisions of a run's front. They build at least
as much line as the length of the front at the hour of containment, at minimum cost and loss (after Donovan
and Rideout 2003). The line closes gaps and bays of the front (--close-gaps) and runs outside its edge
(--indirect). The result names each division that cannot be held, with the nearest feasible plan. Divisions
are sectors around the centre of the burned area, lettered clockwise from north.

  firetwin allocate stations.gpkg RUN --budget 250000 --standard-response engine/3=4,dozer/2=1 --minutes 60

{_LIMITS}

Needs SciPy (pip install 'firetwin[resources]'). The exit status is 1 if there is no allocation; the
reasons are printed on stderr."""


def add(
    parser: argparse.ArgumentParser,
    path: Callable[[str], Path],
    count: Callable[[str], int],
    moment: Callable[[str], datetime],
) -> None:
    """Define the arguments.

    Parameters
    ----------
    path, count, moment
        Converters of arguments.
    """
    parser.add_argument("stations", metavar="STATIONS.gpkg", type=path, help="station file")
    parser.add_argument("run", metavar="RUN", type=path, help="run folder")
    parser.add_argument(
        "--divisions", metavar="N", type=count, default=4, help="number of divisions, up to 26 (4)"
    )
    parser.add_argument(
        "--from",
        dest="start",
        metavar="TIME",
        type=moment,
        help="time of the order, such as 2014-09-17T16:00-07:00 (the ignition)",
    )
    parser.add_argument(
        "--hours", metavar="N", type=count, help="hours after the order (12, or until the end of the run)"
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
        "--ensemble", metavar="DIR", type=path,
        help="forecast of many members: times by which 10 and 50 %% of them reach each control line (none)",
    )  # fmt: skip
    parser.add_argument(
        "--geojson", metavar="FILE", type=path, help="also write lines and resources for maps"
    )
    parser.add_argument("--json", action="store_true", help="write JSON")


def parse_response(text: str) -> dict[str, int]:
    """Parse numbers by type, such as "engine/3=4,dozer/2=1"."""
    found: dict[str, int] = {}
    for part in text.split(","):
        kind, _, number = (word.strip() for word in part.partition("="))
        if not kind or not number.isdecimal() or int(number) < 1:
            raise argparse.ArgumentTypeError(f"must have the form engine/3=4,dozer/2=1, not {text!r}")
        if kind in found:
            raise argparse.ArgumentTypeError(f"names {kind} twice")
        found[kind] = int(number)
    return found


def _amount(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not limits.is_quantity(value):
        most = f"{limits.LARGEST_NUMBER:,.0f}"
        raise argparse.ArgumentTypeError(f"must be a number of at least 0 and at most {most}, not {text!r}")
    return value
