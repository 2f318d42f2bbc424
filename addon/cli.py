"""The command line: ``firetwin sample | info | new | maps | score | imager | build | bake | render | ...``.

Results go to stdout, messages and progress to stderr. Exit status 0: done, 1: failed, 2: bad usage,
130: Ctrl-C. Nothing heavy is imported before it is needed, so that help and mistakes answer at once.
"""

from __future__ import annotations

import argparse
import io
import math
import os
import re
import shlex
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import NoReturn

from .escaped import escaped

EPILOG = """\
a first film, from nothing:
  firetwin sample sample                 write the sample run (synthetic, King-like)
  firetwin info sample                   what is in it
  firetwin render examples/king_fire.toml --out film --resume

a film of your own run:
  firetwin render RUN --out film         cameras and moments are chosen to fit the fire, and told
  firetwin new RUN -o my_scene.toml      the same as a short scene file, to change them
  firetwin render my_scene.toml --out film

`firetwin COMMAND --help` explains a command."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    arguments = _parser().parse_args(argv)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # names of files go out byte for byte
    try:
        from . import commands

        return getattr(commands, arguments.command)(arguments) or 0
    except KeyboardInterrupt:
        print("\nfiretwin: stopped; what was finished is kept", file=sys.stderr)
        return 130
    except BrokenPipeError:  # the reader of our output has gone, as in `firetwin info RUN | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except Exception as error:
        if arguments.debug:
            raise
        return _report(error)


def _passes() -> str:
    """A line about each pass."""
    from .shot import passes

    return "\n".join(f"  {name:<13}{text}" for name, text in passes.helps().items())


def _report(error: Exception) -> int:
    """One line that says what is wrong and what to do; the exit status for it."""
    from .errors import Error, UsageError
    from .progress import say

    if isinstance(error, UsageError):
        say(str(error))
        return 2
    if isinstance(error, Error):
        text = str(error)
    elif isinstance(error, OSError) and error.filename:
        text = f"{error.filename}: {error.strerror}"
    elif isinstance(error, ModuleNotFoundError) and error.name == "bpy":
        text = "Blender's Python module is missing; install it with: pip install 'firetwin[blender]'"
    elif isinstance(error, ModuleNotFoundError) and error.name == f"{__package__}.bench":
        text = "the benchmarks are not in Blender's extension; run them from a checkout (see the README)"
    elif isinstance(error, ModuleNotFoundError) and error.name == "matplotlib":  # not in Blender
        pip = f"{shlex.quote(sys.executable)} -m pip install matplotlib"
        text = f"maps and plots need matplotlib; install it with: {pip}"
    else:
        text = f"unexpected {type(error).__name__}: {error} (run again with --debug for the details)"
    say(text)
    return 1


def _parser() -> argparse.ArgumentParser:
    raw = argparse.RawDescriptionHelpFormatter
    parser = _Parser(
        prog="firetwin",
        description="Turn the output of a fire-atmosphere model into a Blender scene, pictures and films.",
        epilog=EPILOG,
        formatter_class=raw,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="show the versions and exit")
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--debug", action="store_true", help="show a traceback when something fails")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)

    def command(name: str, summary: str, detail: str = "") -> argparse.ArgumentParser:
        text = f"{summary[0].upper()}{summary[1:]}.\n\n{detail}".strip()
        return commands.add_parser(
            name, help=summary, description=text, parents=[common], formatter_class=raw
        )

    sample = command("sample", "write the synthetic King-like sample run", SAMPLE)
    sample.add_argument("out", metavar="OUT", type=_path, help="folder to write; made when missing")
    sample.add_argument("--frames", metavar="N", type=_count, help="only N model times, evenly spread (all)")
    sample.add_argument("--format", choices=("npy", "text"), default="npy", help="kind of field files (npy)")
    sample.add_argument(
        "--pace", metavar="FACTOR", type=_factor, default=1.0, help="a what-if: a fire so fast (1)"
    )

    info = command("info", "show what is in a run", INFO)
    info.add_argument("run", metavar="RUN", type=_path, help="run folder, or a scene file for all its runs")
    info.add_argument("--json", action="store_true", help="write JSON for programs")

    made = command("convert", "make a run of a fire model's own output", CONVERT)
    made.add_argument(
        "paths", metavar="IN", nargs="+", type=_path, help="the model's files, or folders of them"
    )
    made.add_argument("--out", metavar="RUN", type=_path, required=True, help="run folder to write")
    made.add_argument(
        "--start", metavar="TIME", default="", help="when times count from, if files do not say it"
    )
    made.add_argument("--at", metavar="LAT,LON", default="", help="middle of a grid that lies nowhere")
    made.add_argument("--projection", metavar="CRS", default="", help="of grids in metres, such as EPSG:5070")
    made.add_argument(
        "--interval", metavar="SECONDS", type=_count, default=0, help="between times that are made (chosen)"
    )
    made.add_argument("--name", default="", help="what the run is called (as its folder, with the model)")
    zone = "zone that times are told in, such as Europe/Paris (that of --start, else by longitude)"
    made.add_argument("--zone", default="", help=zone)

    new = command("new", "write a short scene file that fits a run", NEW)
    new.add_argument("run", metavar="RUN", type=_path, help="run folder")
    new.add_argument("-o", "--out", metavar="SCENE.toml", type=_path, required=True, help="file to write")
    for name, word in (("start", "begins"), ("end", "ends")):
        text = f"when the film {word}, such as 2014-09-17T16:00-07:00 (found)"
        new.add_argument(f"--{name}", metavar="TIME", type=_moment, help=text)
    new.add_argument("--overwrite", action="store_true", help="in place of a file that is there")

    maps = command("maps", "draw the fuel map and the fire intensity map", MAPS)
    maps.add_argument("run", metavar="RUN", type=_path, help="run folder")
    maps.add_argument("--out", metavar="DIR", type=_path, required=True, help="folder for the PNG files")

    maps.add_argument(
        "--against", metavar="FILE", nargs="+", default=[], help="perimeters to draw (RUN/observations)"
    )

    score = command("score", "how well a run matches what was seen of its fire", SCORE)
    score.add_argument(
        "run", metavar="RUN", type=_path, help="run folder, or a scene file: its first run against the other"
    )
    score.add_argument(
        "--against",
        metavar="FILE|RUN",
        nargs="+",
        default=[],
        help="perimeters, detections, or one other run (RUN/observations)",
    )
    score.add_argument(
        "--report", metavar="X.html", type=_path, help="write a page with maps and curves (none)"
    )
    score.add_argument("--json", action="store_true", help="write JSON for programs")

    seen = command("imager", "what a satellite's imager would have measured of a run", IMAGER)
    seen.add_argument("run", metavar="RUN", type=_path, help="run folder")
    seen.add_argument("--out", metavar="DIR", type=_path, required=True, help="folder for the GeoTIFF files")
    seen.add_argument("--instrument", choices=("abi", "viirs"), default="abi", help="which imager (abi)")
    seen.add_argument(
        "--longitude",
        metavar="DEG",
        type=_longitude,
        default=-137.0,
        help="where abi stands, degrees east (-137)",
    )
    seen.add_argument(
        "--every", metavar="SECONDS", type=_count, default=900, help="model time between pictures (900)"
    )

    build = command("build", "build the scene and save it as a .blend file", BUILD)
    _scene(build)
    build.add_argument("-o", "--out", metavar="X.blend", type=_path, required=True, help="file to write")
    build.add_argument("--run", metavar="NAME", type=_name, help="with this one of [[runs]] (the first run)")

    bake = command("bake", "write the smoke volumes that the scene needs", BAKE)
    _scene(bake)

    render = command("render", "render pictures and films", RENDER.format(passes=_passes()))
    _scene(render)
    render.add_argument("--out", metavar="DIR", type=_path, required=True, help="folder for the pictures")
    render.add_argument(
        "--frames",
        metavar="LIST",
        help="of each camera's frames, such as 1-10, 3,5-9 or 1-48:4 (all)",
    )
    render.add_argument(
        "--camera", metavar="NAME", type=_name, help="this camera only (all), drone@RUN in one run"
    )
    render.add_argument("--passes", metavar="LIST", help="such as rgb,thermal (as the scene file says)")
    render.add_argument("--resume", action="store_true", help="keep what is finished and still matches")
    render.add_argument("--json", action="store_true", help="write JSON for programs: files, and memory")

    track = command("track", "write a camera's way as a GPX track", TRACK)
    _scene(track)
    track.add_argument("--camera", metavar="NAME", type=_name, help="this camera (the first)")
    track.add_argument("--out", metavar="FILE.gpx", type=_path, required=True, help="file to write")

    cache = command("cache", "list the smoke volumes that are kept, or make room", CACHE)
    cache.add_argument(
        "places", metavar="SCENE|DIR", nargs="*", type=_path, help="scene files or cache folders (./cache)"
    )
    cache.add_argument("--prune", action="store_true", help="remove volumes used longest ago")
    cache.add_argument(
        "--limit",
        metavar="SIZE",
        type=_size,
        default=_size("20GB"),
        help="such as 500MB; keep as much (20GB)",
    )
    cache.add_argument("--dry-run", action="store_true", help="say what --prune would remove, remove nothing")

    assets = command("assets", "write trees, materials and node groups as an asset library", ASSETS)
    assets.add_argument(
        "scene", metavar="SCENE.toml", nargs="?", type=_path, help="scene file (the sample's)"
    )
    assets.add_argument("--out", metavar="DIR", type=_path, required=True, help="folder of the library")

    command("schema", "print the JSON Schema of scene files, for TOML editors", SCHEMA)

    bench = command("bench", "measure run time against error, beside the alternatives", BENCH)
    bench.add_argument("--out", metavar="DIR", type=_path, help="folder for bench.json and the plots (none)")
    bench.add_argument("--full", action="store_true", help="more repetitions, rivals at every size (minutes)")
    bench.add_argument(
        "--runs", metavar="N", type=_count, default=1, help="measure all of it N times, for ranges (1)"
    )
    form = bench.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="write JSON for programs")
    form.add_argument("--markdown", action="store_true", help="write Markdown tables")
    return parser


def _scene(
    parser: argparse.ArgumentParser, help: str = "scene file, or a run folder: settings are fitted to it"
) -> None:
    parser.add_argument("scene", metavar="SCENE|RUN", type=_path, help=help)


def _name(text: str) -> str:
    if not text.strip():
        raise argparse.ArgumentTypeError("is empty; give a name, or leave the option out")
    return text


def _path(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("is empty; name a file or a folder")
    return Path(text)


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number above 0, not {text!r}")
    return int(text)


def _moment(text: str) -> datetime:
    try:
        value = datetime.fromisoformat(text)
    except ValueError:
        value = None
    if value is None or value.tzinfo is None:
        raise argparse.ArgumentTypeError(
            f"must be a time with its zone, 2014-09-17T16:00-07:00, not {text!r}"
        )
    return value.astimezone(UTC)


def _factor(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.1 <= value <= 3.0:
        raise argparse.ArgumentTypeError(f"must be a number from 0.1 to 3, not {text!r}")
    return value


def _longitude(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not -360.0 <= value <= 360.0:
        raise argparse.ArgumentTypeError(f"must be a number of degrees east from -360 to 360, not {text!r}")
    return value


_UNITS = {"": 1, "B": 1, "KB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}


def _size(text: str) -> int:
    found = re.fullmatch(r"(\d+(?:\.\d+)?) ?([A-Za-z]*)", text.strip(), re.ASCII)
    if not found or found[2].upper() not in _UNITS:
        raise argparse.ArgumentTypeError(f"must be a size such as 500MB or 20GB, not {text!r}")
    return round(float(found[1]) * _UNITS[found[2].upper()])


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        super().error(escaped(message))


class _Version(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        import firetwin_core

        libraries = ", ".join(f"{name} {version}" for name, version in firetwin_core.build_info().items())
        print(f"firetwin {firetwin_core.__version__} ({libraries})")
        parser.exit()


SAMPLE = """\
No output of the fire-atmosphere model for the King Fire is public. This run is made up: its terrain, fuels
and spread follow what is published about the fire, and everything made from it says that it is synthetic."""

ASSETS = """\
DIR/firetwin_assets.blend and DIR/blender_assets.cats.txt, as Blender's asset browser reads them: choose DIR
under Edit > Preferences > File Paths > Asset Libraries. Lit, hazy and as warm as the scene file's shot is."""

INFO = """\
Grid and extent, fuels, times, heat flux, energy, burned area (beside the reported acreages where the run
depicts a known fire), and warnings."""

CONVERT = """\
Reads, found by content: WRF-SFIRE (wrfout*), NCAR's Community Fire Behavior Model (fire_output_*.nc),
ForeFire (arrival times, fronts, landscape), ELMFIRE (GeoTIFF), FARSITE and FlamMap (ASCII or GeoTIFF, LCP),
pyretechnics (.npz), and any CF netCDF by a mapping in a TOML file: [fields] heat_flux = "NAME". Fuels may
come from an LCP or LANDFIRE's rasters among the files. What a model does not say is assumed, said, and
written to run.toml. Files of several runs, models or places in one call are refused. Clocks tell the time of
--zone; without it that of the offset in --start, else the hours that the longitude says, which know no summer
time and no borders. A conversion that was stopped goes on when the command is given again; one that has read
and written nothing for ten minutes is ended, as a damaged file may keep its library busy for ever.
Needs packages that are not installed by themselves: pip install 'firetwin[models]'."""

NEW = """\
The most active part of the run, and cameras as large as the fire: an overview from the windward side with the
sun behind it, one that goes along with the head, one close to a flank, one from above. Each is moved until at
least half of the front that it films is in the picture and not behind ground or much smoke; how much shows
is said. `render`, `build` and `bake` of RUN itself take the same settings."""

MAPS = """\
DIR/fuel.png        fuel load, greener is denser
DIR/intensity.png   strongest heat flux of the whole run, light yellow to red, over the relief"""

SCORE = """\
FILE holds dated perimeters (.geojson, .shp, .kml, .kmz, .gpkg) or FIRMS detections of VIIRS and MODIS (.csv);
one without dates is written FILE@2014-09-18T04:00-07:00. By date: areas, Sorensen, Jaccard, kappa, precision,
recall, shape deviation and area difference indices, distances of the perimeters, with and without what had
burned when the run began; then errors of arrival times, and detections with their lag. Each is found on
polygons and on cells: the difference of the two is its error. Observations before or after the run's times or
outside of its grid are counted and left out; where none is left, the exit status is 1. Needs shapely and
pyproj (pip install 'firetwin[score]')."""

IMAGER = """\
Brightness temperatures (K) at 3.9 and 11.2 um (3.74 and 11.45 for viirs), fire radiative power (W) and a mask
of fire (10) and saturated (11) pixels, as DIR/abi_20140917T2200Z.tif: abi in its geostationary projection
with 2 km pixels, viirs at 375 m by latitude and longitude. Fire counts by its area in a pixel. Power is abi's
from 3.9 um, saturated at 400 K, and viirs's from its band M13 of 750 m, saturated at 634 K. Hypothetical:
neither saw the fires of 2014 so. Needs rasterio (pip install 'firetwin[raster]'). Passes imager_short and
imager_long of a satellite's camera are pictures and films of them."""

BUILD = """\
The file needs no add-on to be opened, scrubbed and rendered; its smoke volumes stay in the cache folder."""

BAKE = """\
`render` and `build` do this by themselves; bake alone to spread the work or to look at the volumes."""

RENDER = """\
DIR/CAMERA/PASS/CAMERA_PASS_000001.png   and .exr, whatever the pass has
DIR/CAMERA/CAMERA_PASS.mp4               films of pictures, with the model time in each frame
DIR/manifest.json                        settings, versions, input hashes, a hash of every file

passes:
{passes}

Without --resume everything asked for is rendered again. Several renders, also of several computers, may write
to one folder at once: they share the frames. Memory to expect is told before the first frame; --json gives it
at the end (bytes), with the peak that was measured, how many pictures were made and which files there are."""

TRACK = """\
A point per frame: WGS84 degrees, metres above the sea (the datum of the run's elevations) and the model time
in UTC. A drone with track = "FILE.gpx" flies it again; flight planners and maps read it too."""

CACHE = """\
Lists each shot's volumes with their size and last use, those used last first. With --prune the ones used
longest ago go, until the rest fits into --limit; what a bake or a render is using stays."""

SCHEMA = """\
Save it and name it in the first line of a scene file (`#:schema firetwin.json`): editors that know TOML then
complete keys, show what they mean and underline mistakes."""

BENCH = """\
Every tool is measured in this run, on this machine, in turn with its rivals: the median of five or more
repetitions, with their range. Takes about seven minutes on two cores; --runs 3 says how much the figures
differ from run to run. Rivals that are not installed are named and left out (pip install 'firetwin[bench]'
brings them). Exit status 1 when a target is missed."""
