"""`firetwin convert`: a fire model's output as a run."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import RUNS, Command, add_origin
from ..progress import Reporter, result, say

_DETAIL = """\
The format is detected from the content: WRF-SFIRE (wrfout*), NCAR's Community Fire Behavior Model
(fire_output_*.nc), ForeFire (arrival times, fronts, landscape), ELMFIRE (GeoTIFF), FARSITE and FlamMap
(ASCII or GeoTIFF, LCP), pyretechnics (.npz), and any CF netCDF with a mapping in a TOML file: [fields]
heat_flux = "NAME". Fuels can come from an LCP or from LANDFIRE rasters among the files. Values that the
model does not provide are assumed, printed and written to run.toml. One call converts one run; files of
several runs, models or places are rejected. Clocks show the time of --zone; without it, the UTC offset of
--start; without both, the offset by longitude, ignoring daylight saving time and borders. Repeating the
command resumes a stopped conversion. A conversion that reads and writes nothing for ten minutes is ended,
as the file is probably damaged. Needs optional packages: pip install 'firetwin[models]'."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument(
        "paths",
        metavar="IN",
        nargs="+",
        type=types.path,
        help="output files of the model, or folders of them",
    )
    parser.add_argument("--out", metavar="RUN", type=types.path, required=True, help="run folder to write")
    add_origin(parser)
    parser.add_argument(
        "--interval",
        metavar="SECONDS",
        type=types.count,
        default=0,
        help="time step of the fields if the model writes arrival times (fitted)",
    )
    parser.add_argument(
        "--member", metavar="NAME", default="", help="convert a member of the ensemble IN to a run"
    )
    parser.add_argument(
        "--wind",
        metavar="GRIB2",
        nargs="+",
        type=types.path,
        default=[],
        help="forecast of HRRR for the wind at 10 m, if the model writes none: a file per hour",
    )


def _run(arguments: argparse.Namespace) -> None:
    """Convert a fire model's own files to a run."""
    from ..jobs import convert

    reporter = Reporter("times")
    try:
        result(
            convert.run(
                arguments.paths, arguments.out, arguments.start, arguments.at, arguments.projection,
                arguments.interval, reporter, say, name=arguments.name, zone=arguments.zone,
                member=arguments.member, wind=arguments.wind,
            )
        )  # fmt: skip
    finally:
        reporter.close()


COMMAND = Command("convert", "convert a fire model's output to a run", _DETAIL, RUNS, _run, _add)
