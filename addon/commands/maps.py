"""`firetwin maps`: maps of a run."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import RUNS, Command, add_overwrite
from ..progress import result, say

_DETAIL = """\
DIR/fuel.png        surface and canopy fuel together, kg/m2; greener is denser
DIR/intensity.png   maximum heat flux of the run, light yellow to red, over shaded relief"""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    parser.add_argument(
        "--out", metavar="DIR", type=types.path, required=True, help="folder for the PNG files"
    )
    parser.add_argument(
        "--against",
        metavar="FILE",
        nargs="+",
        default=[],
        help="observed perimeters to draw (RUN/observations)",
    )
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Draw the maps of a run."""
    from ..run import readers

    run = readers.open(arguments.run)
    say("drawing the maps of the fuel load and of the maximum heat flux")
    from ..run import maps, observations, zone

    observed = observations.read(arguments.against or observations.beside(arguments.run))
    clock = zone.time_zone(run)
    for path in maps.draw(run, arguments.out, clock, observed, overwrite=arguments.overwrite):
        result(path)


COMMAND = Command(
    "maps", "draw maps of the fuel load and of the maximum heat flux", _DETAIL, RUNS, _run, _add
)
