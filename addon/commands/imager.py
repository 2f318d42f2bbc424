"""`firetwin imager`: a satellite imager's measurements of a run."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import RUNS, Command, add_overwrite
from ..progress import Reporter, result

_DETAIL = """\
Brightness temperatures (K) at 3.9 and 11.2 um (3.74 and 11.45 for viirs), fire radiative power (W) and a
mask of fire (10) and saturated (11) pixels, in DIR/abi_20140917T2200Z.tif. abi has a geostationary
projection and a ground sample distance of 2 km; viirs has a latitude-longitude grid and 375 m. Radiance is
weighted by the area of fire in a pixel. For the fire power, the detectors saturate at 400 K (abi, 3.9 um)
and 634 K (viirs, band M13, 750 m). The images are hypothetical: ABI was not yet in orbit in 2014, and
observations of VIIRS are not used. The passes imager_short and imager_long of a satellite camera show such
images. Needs rasterio (pip install 'firetwin[raster]')."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    parser.add_argument(
        "--out", metavar="DIR", type=types.path, required=True, help="folder for the GeoTIFF files"
    )
    parser.add_argument("--instrument", choices=("abi", "viirs"), default="abi", help="instrument (abi)")
    parser.add_argument(
        "--longitude",
        metavar="DEG",
        type=types.longitude,
        default=-137.0,
        help="longitude of the geostationary satellite of abi, degrees east (-137)",
    )
    parser.add_argument(
        "--every",
        metavar="SECONDS",
        type=types.count,
        default=900,
        help="model time between pictures, s (900)",
    )
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write the simulated measurements of a satellite's imager."""
    from .. import output
    from ..errors import UsageError, input_error
    from ..run import readers, times
    from ..shot.satellites import geotiff, imager

    run = readers.open(arguments.run)
    instrument = imager.INSTRUMENTS[arguments.instrument]
    moments = imager.times(run, arguments.every)
    report = Reporter("pictures")
    names = [f"{instrument.name}_{times.utc(run, time):%Y%m%dT%H%M}Z.tif" for time in moments]
    for name in names:
        output.check(arguments.out / name, arguments.overwrite)
    try:
        for done, (time, picture) in enumerate(imager.film(instrument, run, arguments.longitude, moments)):
            report(done, len(moments))
            moment = times.utc(run, time)
            path = arguments.out / names[done]
            geotiff.write(path, picture, instrument, run.name, moment, arguments.overwrite)
            result(path)
    except imager.HorizonError as error:
        raise UsageError(f"--longitude: {error}") from None
    except imager.NothingSeenError as error:
        finer = "; try --instrument viirs, which has smaller pixels" if instrument is imager.ABI else ""
        raise input_error(arguments.run, f"{error}{finer}") from None
    report(len(moments), len(moments))


COMMAND = Command("imager", "simulate a satellite imager's measurements of a run", _DETAIL, RUNS, _run, _add)
