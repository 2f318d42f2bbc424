"""Command line: parsers, help, exit codes, and the commands that they call.

Results go to stdout, messages and progress to stderr. Exit status 0: done, 1: failed, 2: bad usage, 130:
Ctrl-C, 143: SIGTERM. Heavy modules are imported on demand, so that help and usage errors answer at once.
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

from . import rooms
from .escaped import escaped
from .stations import arguments as stations
from .tiles import arguments as tiles

EPILOG = """\
a first film, from the sample run:
  firetwin sample sample                 write the sample run (synthetic, King-like)
  firetwin info sample                   list its content
  firetwin render examples/king_fire.toml --out film --resume

a film of your own run:
  firetwin render RUN --out film         cameras and times are fitted to the fire, and printed
  firetwin new RUN -o my_scene.toml      write them to a short scene file, to change them
  firetwin render my_scene.toml --out film

`firetwin COMMAND --help` explains a command."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    words = _current_names(list(sys.argv[1:] if argv is None else argv))
    options: list[str] = []
    room = rooms.COMMANDS.get(words[0]) if words else None
    if room and not rooms.is_installed(room):
        from .progress import say

        say(f"the command {words[0]} needs the package firetwin/{room}, which is missing; reinstall Firetwin")
        return 2
    if room == "farm":
        from .farm import arguments as farm

        words, options = farm.split_options(words)
    arguments = _parser().parse_args(words)
    arguments.options = options
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # file names are written byte for byte
    try:
        from . import commands

        return getattr(commands, arguments.command)(arguments) or 0
    except KeyboardInterrupt:
        print("\nfiretwin: stopped; what was finished is kept", file=sys.stderr)
        return 130
    except BrokenPipeError:  # broken pipe, as in `firetwin info RUN | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except Exception as error:
        if arguments.debug:
            raise
        return _report(error)


def _current_names(words: list[str]) -> list[str]:
    """Replace the former name of a command or an option, with a note."""
    from .progress import say

    if words[:1] == ["places"]:
        say("`firetwin places` is now `firetwin stations`; the former name works until the next version")
        return ["stations", *words[1:]]
    if words[:1] == ["brief"] and any(re.match(r"--places(=|$)", word) for word in words):
        say("`--places` is now `--stations`; the former name works until the next version")
        return [re.sub(r"^--places(?==|$)", "--stations", word) for word in words]
    return words


def _passes() -> str:
    """Help line of each pass."""
    from .shot import passes

    return "\n".join(f"  {name:<13}{text}" for name, text in passes.helps().items())


def _report(error: Exception) -> int:
    """Print an error with its remedy in one line; returns the exit status."""
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
    elif isinstance(error, ModuleNotFoundError) and error.name in ("matplotlib", "PIL"):  # not in Blender
        pip = f"{shlex.quote(sys.executable)} -m pip install matplotlib"  # it brings Pillow
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
    common = _Parser(add_help=False)
    common.add_argument("--debug", action="store_true", help="show a traceback when something fails")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)

    def command(name: str, summary: str, detail: str = "") -> argparse.ArgumentParser:
        text = f"{summary[0].upper()}{summary[1:]}.\n\n{detail}".strip()
        return commands.add_parser(
            name, help=summary, description=text, parents=[common], formatter_class=raw
        )

    sample = command("sample", "write the synthetic King-like sample run", SAMPLE)
    sample.add_argument("out", metavar="OUT", type=_path, help="output folder; created if missing")
    sample.add_argument(
        "--frames", metavar="N", type=_count, help="number of model times, evenly spread (all)"
    )
    sample.add_argument(
        "--format", choices=("npy", "text"), default="npy", help="format of field files (npy)"
    )
    sample.add_argument(
        "--pace",
        metavar="FACTOR",
        type=_factor,
        default=1.0,
        help="factor of the rate of spread, for a what-if run (1)",
    )

    info = command("info", "list the content of a run", INFO)
    info.add_argument("run", metavar="RUN", type=_path, help="run folder, or a scene file: all its runs")
    info.add_argument("--json", action="store_true", help="write JSON")

    made = command("convert", "convert a fire model's output to a run", CONVERT)
    made.add_argument(
        "paths", metavar="IN", nargs="+", type=_path, help="output files of the model, or folders of them"
    )
    made.add_argument("--out", metavar="RUN", type=_path, required=True, help="run folder to write")
    made.add_argument(
        "--start", metavar="TIME", default="", help="start time of the run, if the files do not give it"
    )
    made.add_argument(
        "--at", metavar="LAT,LON", default="", help="centre of a grid without geographic coordinates"
    )
    made.add_argument(
        "--projection",
        metavar="CRS",
        default="",
        help="coordinate reference system of grids in metres, such as EPSG:5070",
    )
    made.add_argument(
        "--interval",
        metavar="SECONDS",
        type=_count,
        default=0,
        help="time step of the run's fields, where the model gives arrival times (chosen)",
    )
    made.add_argument("--name", default="", help="name of the run (its folder's, with the model's)")
    zone = "time zone of printed times, such as Europe/Paris (that of --start, otherwise by longitude)"
    made.add_argument("--zone", default="", help=zone)

    new = command("new", "write a short scene file that fits a run", NEW)
    new.add_argument("run", metavar="RUN", type=_path, help="run folder")
    new.add_argument("-o", "--out", metavar="SCENE.toml", type=_path, required=True, help="file to write")
    for name, word in (("start", "first"), ("end", "last")):
        text = f"model time of the {word} frame, such as 2014-09-17T16:00-07:00 (fitted)"
        new.add_argument(f"--{name}", metavar="TIME", type=_moment, help=text)
    new.add_argument("--overwrite", action="store_true", help="replace an existing file")

    maps = command("maps", "draw the fuel map and the fire intensity map", MAPS)
    maps.add_argument("run", metavar="RUN", type=_path, help="run folder")
    maps.add_argument("--out", metavar="DIR", type=_path, required=True, help="folder for the PNG files")

    maps.add_argument(
        "--against",
        metavar="FILE",
        nargs="+",
        default=[],
        help="observed perimeters to draw (RUN/observations)",
    )

    score = command("score", "score a run against observations of its fire", SCORE)
    score.add_argument(
        "run",
        metavar="RUN",
        type=_path,
        help="run folder, or a scene file: its first run is scored against its second",
    )
    score.add_argument(
        "--against",
        metavar="FILE|RUN",
        nargs="+",
        default=[],
        help="observed perimeters, detections, or another run (RUN/observations)",
    )
    score.add_argument(
        "--report", metavar="X.html", type=_path, help="write an HTML report with maps and curves (none)"
    )
    score.add_argument("--json", action="store_true", help="write JSON")

    if rooms.is_installed("brief"):
        from .brief import arguments as brief

        brief.add(command("brief", "write a briefing page of a run", brief.DETAIL), _path, _size)

    imager = command("imager", "simulate a satellite imager's measurements of a run", IMAGER)
    imager.add_argument("run", metavar="RUN", type=_path, help="run folder")
    imager.add_argument(
        "--out", metavar="DIR", type=_path, required=True, help="folder for the GeoTIFF files"
    )
    imager.add_argument("--instrument", choices=("abi", "viirs"), default="abi", help="instrument (abi)")
    imager.add_argument(
        "--longitude",
        metavar="DEG",
        type=_longitude,
        default=-137.0,
        help="longitude of abi's geostationary orbit, degrees east (-137)",
    )
    imager.add_argument(
        "--every", metavar="SECONDS", type=_count, default=900, help="model time between pictures, s (900)"
    )

    build = command("build", "build the scene and save it as a .blend file", BUILD)
    _scene(build)
    build.add_argument("-o", "--out", metavar="X.blend", type=_path, required=True, help="file to write")
    build.add_argument(
        "--run", metavar="NAME", type=_name, help="name of the run of [[runs]] (the first run)"
    )
    tiles.add_access(build)

    bake = command("bake", "write the smoke volumes that the scene needs", BAKE)
    _scene(bake)

    render = command("render", "render pictures and films", RENDER.format(passes=_passes()))
    _scene(render)
    render.add_argument("--out", metavar="DIR", type=_path, required=True, help="folder for the pictures")
    render.add_argument(
        "--frames",
        metavar="LIST",
        help="frames of each camera, such as 1-10, 3,5-9 or 1-48:4 (all)",
    )
    render.add_argument(
        "--camera", metavar="NAME", type=_name, help="name of the camera (all); drone@RUN for one run"
    )
    render.add_argument(
        "--passes", metavar="LIST", help="passes, such as rgb,thermal (those of the scene file)"
    )
    render.add_argument(
        "--resume",
        action="store_true",
        help="keep finished pictures whose settings and inputs have not changed",
    )
    render.add_argument("--json", action="store_true", help="write JSON: files and memory")
    tiles.add_access(render)

    if rooms.is_installed("farm"):
        from .farm import arguments as farm

        farm.add(command("farm", "plan a film for a render farm", farm.DETAIL), _path, _count)
    tiles.add(command("tiles", "read and make 3D tilesets", tiles.DETAIL), _path, _count)
    if rooms.is_installed("allocation"):
        from .allocation import arguments as allocation

        summary = "suggest an allocation of resources (exercise)"
        allocation.add(command("allocate", summary, allocation.DETAIL), _path, _count, _moment)

    track = command("track", "write a camera's path as a GPX track", TRACK)
    _scene(track)
    track.add_argument("--camera", metavar="NAME", type=_name, help="name of the camera (the first)")
    track.add_argument("--out", metavar="FILE.gpx", type=_path, required=True, help="file to write")

    cache = command("cache", "list cached smoke volumes and tiles, or remove the least recently used", CACHE)
    cache.add_argument(
        "places", metavar="SCENE|DIR", nargs="*", type=_path, help="scene files or cache folders (./cache)"
    )
    cache.add_argument("--prune", action="store_true", help="remove the least recently used")
    cache.add_argument(
        "--limit",
        metavar="SIZE",
        type=_size,
        default=_size("20GB"),
        help="size of the cache after --prune, such as 500MB (20GB)",
    )
    cache.add_argument(
        "--answers",
        metavar="SIZE",
        type=_size,
        default=_size("4GB"),
        help="size of what is kept of tile servers' answers after --prune (4GB)",
    )
    cache.add_argument(
        "--dry-run", action="store_true", help="list what --prune would remove; remove nothing"
    )

    stations.add_stations(
        command("stations", "make or list a file of stations and resources", stations.STATIONS), _path
    )
    stations.add_resources(
        command("resources", "list resources that answer a query", stations.RESOURCES), _path, _moment
    )

    assets = command("assets", "write an asset library of trees, materials and node groups", ASSETS)
    assets.add_argument(
        "scene", metavar="SCENE.toml", nargs="?", type=_path, help="scene file (the sample's)"
    )
    assets.add_argument("--out", metavar="DIR", type=_path, required=True, help="folder of the library")

    command("schema", "print the JSON Schema of scene files, for TOML editors", SCHEMA)

    bench = command("bench", "benchmark run time and error against alternatives", BENCH)
    bench.add_argument(
        "--runs", metavar="N", type=_count, default=1, help="number of repeated benchmarks, for ranges (1)"
    )
    form = bench.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="write JSON")
    form.add_argument("--markdown", action="store_true", help="write Markdown tables")
    return parser


def _scene(
    parser: argparse.ArgumentParser, help: str = "scene file, or run folder: settings are fitted to the run"
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
    match = re.fullmatch(r"(\d+(?:\.\d+)?) ?([A-Za-z]*)", text.strip(), re.ASCII)
    if not match or match[2].upper() not in _UNITS:
        raise argparse.ArgumentTypeError(f"must be a size such as 500MB or 20GB, not {text!r}")
    return round(float(match[1]) * _UNITS[match[2].upper()])


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
No fire-atmosphere model output for the King Fire is public. This run is synthetic: terrain, fuels and
spread follow publications about the fire. All output made from it is labelled as synthetic."""

ASSETS = """\
Writes DIR/firetwin_assets.blend and DIR/blender_assets.cats.txt for Blender's asset browser. Add DIR under
Edit > Preferences > File Paths > Asset Libraries. Light, haze and temperatures are those of the scene
file."""

INFO = """\
Lists grid, extent, fuels, times, heat flux, energy, burned area and warnings. Reported acreages stand
beside the burned area if the run depicts a known fire."""

CONVERT = """\
The format is found by content: WRF-SFIRE (wrfout*), NCAR's Community Fire Behavior Model
(fire_output_*.nc), ForeFire (arrival times, fronts, landscape), ELMFIRE (GeoTIFF), FARSITE and FlamMap
(ASCII or GeoTIFF, LCP), pyretechnics (.npz), and any CF netCDF with a mapping in a TOML file: [fields]
heat_flux = "NAME". Fuels may come from an LCP or LANDFIRE's rasters among the files. Values that a model
does not give are assumed, printed and written to run.toml. One call converts one run; files of several
runs, models or places are refused. Clocks show the time of --zone. Without --zone they show the offset of
--start; without both, the offset by longitude, without daylight saving time and borders. A stopped
conversion resumes when the command is repeated. A conversion without a heartbeat (nothing read or written)
for ten minutes is ended: the file may be damaged. Needs optional packages: pip install 'firetwin[models]'."""

NEW = """\
Selects the most active part of the run. Fits cameras to the fire: an overview from upwind with the sun
behind it, a chase of the head, a close view of a flank, and a view from above. Each camera is moved until
at least half of its front is in the frustum and not occluded by terrain or dense smoke; the visible share
is printed. `render`, `build` and `bake` of RUN use the same settings."""

MAPS = """\
DIR/fuel.png        surface and canopy fuel together, kg/m2; greener is denser
DIR/intensity.png   maximum heat flux of the run, light yellow to red, over shaded relief"""

SCORE = """\
FILE holds dated perimeters (.geojson, .shp, .kml, .kmz, .gpkg) or FIRMS detections of VIIRS and MODIS
(.csv). A file without dates is written FILE@2014-09-18T04:00-07:00. Scores by date: areas, Sorensen,
Jaccard, kappa, precision, recall, shape deviation and area difference indices, and distances of the
perimeters, with and without the area burned before the run began. Further scores: errors of arrival times,
and detections with their lag. Each score is computed on polygons and on cells; their difference is its
error. Observations outside the run's times or grid are counted and left out. The exit status is 1 if none
remains. Needs shapely and pyproj (pip install 'firetwin[score]')."""

IMAGER = """\
Brightness temperatures (K) at 3.9 and 11.2 um (3.74 and 11.45 for viirs), fire radiative power (W) and a
mask of fire (10) and saturated (11) pixels, as DIR/abi_20140917T2200Z.tif. abi has its geostationary
projection and a ground sample distance of 2 km; viirs has latitude and longitude and 375 m. Radiance is
weighted by the area of fire in a pixel. Detector saturation of the power is 400 K for abi (3.9 um) and 634
K for viirs (band M13, 750 m). The images are hypothetical: neither instrument observed the fires of 2014
in this way. Needs rasterio (pip install 'firetwin[raster]'). The passes imager_short and imager_long of a
satellite camera show them."""

BUILD = """\
The file can be opened, played and rendered without the add-on. Its smoke volumes stay in the cache folder."""

BAKE = """\
`render` and `build` bake missing volumes themselves. Bake alone to spread the work or to inspect the
volumes."""

RENDER = """\
DIR/CAMERA/PASS/CAMERA_PASS_000001.png   and .exr, by pass
DIR/CAMERA/CAMERA_PASS.mp4               films, with the model time in each frame
DIR/manifest.json                        settings, versions, hashes of inputs and files

passes:
{passes}

Without --resume all selected frames are rendered again. Several renders, also on several computers, can
write to one folder at the same time: they share the frames by leases. Give each of them --resume and the
same scene file, run, Firetwin and Blender.

The expected memory is printed before the first frame if there is an estimate: for smoke that is a solved
flow drawn along rays, and for pictures without smoke. --json prints at the end: expected and peak memory
(bytes, null where unknown), number of pictures that this render made, and files."""

TRACK = """\
One point per frame: WGS84 degrees, metres above sea level (the datum of the run's elevations) and model
time in UTC. A drone with track = "FILE.gpx" follows the track. Flight planners and maps read it too."""

CACHE = """\
Lists each shot's volumes and tiles with size and last use, most recent first, and then the user's answers of
tile servers. --prune removes the least recently used until the rest fits into --limit, and answers into
--answers. What a bake or a render uses is kept."""

SCHEMA = """\
Save it and name it in the first line of a scene file (`#:schema firetwin.json`). TOML editors then
complete keys, show their help and underline mistakes."""

BENCH = """\
Measures ten steps on this machine, alternating with their alternatives: median and range of five or more
repetitions. Takes about three minutes of processor time. --runs 3 shows the variation between runs.
Alternatives that are not installed are named and left out (pip install 'firetwin[bench]' installs them).
The exit status is 1 if a target is missed."""
