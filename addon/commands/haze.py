"""`firetwin haze`: smoke of a weather forecast."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import RUNS, Command, add_overwrite
from ..progress import result

_DETAIL = """\
GRIB2 are files of HRRR (wrfsfc) with smoke: MASSDEN at 8 m and COLMD. Prints density, column mass, visual
range (only smoke, contrast of 2 %) and optical depth over the run at each valid time, and the lines of a
scene file for --time: light.smoke and light.smoke_height. Extinction is 4 m2/g; measured values are 3.3 to
7.4 m2/g. Fields of zeros are refused, as they are not clean air. Needs rasterio and pyproj."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    parser.add_argument(
        "forecast", metavar="GRIB2", nargs="+", type=types.path, help="files of HRRR, one per hour"
    )
    parser.add_argument(
        "--time",
        metavar="TIME",
        type=types.moment,
        help="time of the scene, such as 2014-09-17T16:00-07:00 (the one nearest to mid-run)",
    )
    parser.add_argument(
        "--out", metavar="DIR", type=types.path, help="folder for a map of the smoke's column mass"
    )
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Read the smoke of a weather forecast over a run, for the haze of a scene."""
    from ..run import readers

    run = readers.open(arguments.run)
    from ..run import times, zone
    from ..shot.light import smoke_forecast

    clock = zone.time_zone(run)
    smokes = smoke_forecast.read(run, arguments.forecast)
    middle = times.utc(run, float(run.times[0] + run.times[-1]) / 2.0)
    nearest = min(smokes, key=lambda each: abs((each.valid - middle).total_seconds()))
    chosen = smoke_forecast.at(smokes, arguments.time) if arguments.time else nearest
    result(smoke_forecast.page(smokes, chosen, clock))
    if arguments.out:
        from ..run import maps

        text = f"forecast of {times.text(chosen.issued, clock)} for {times.text(chosen.valid, clock)}"
        path = arguments.out / f"smoke_{chosen.valid:%Y%m%dT%H%MZ}.png"
        maps.save(maps.smoke_map(run, chosen.column, text), path, arguments.overwrite)
        result(path)


COMMAND = Command(
    "haze", "read the smoke of a weather forecast for a scene's haze", _DETAIL, RUNS, _run, _add
)
