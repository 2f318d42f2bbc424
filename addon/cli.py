"""Command line: parsers, help, exit codes, and the commands that they call.

Results go to stdout, messages and progress to stderr. Exit status 0: done, 1: failed, 2: bad usage, 130:
Ctrl-C, 143: SIGTERM. Heavy modules are imported on demand, so that help and usage errors answer at once.
"""

from __future__ import annotations

import argparse
import io
import keyword
import os
import re
import shlex
import sys
from collections.abc import Sequence
from typing import NoReturn

from . import argument_types as types
from . import help_texts, optional_features
from .escaped import escaped
from .stations import arguments as stations
from .tiles import arguments as tiles


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status."""
    words = _current_names(list(sys.argv[1:] if argv is None else argv))
    options: list[str] = []
    package = optional_features.COMMANDS.get(words[0]) if words else None
    if package and not optional_features.is_installed(package):
        from .progress import say

        say(f"the command {words[0]} needs firetwin/{package}, which is missing; reinstall Firetwin")
        return 2
    if package == "farm":
        from .farm import arguments as farm

        words, options = farm.split_options(words)
    if package == "dataset":
        from .dataset import arguments as dataset

        words = dataset.insert_verb(words)
    arguments = _parser().parse_args(words)
    arguments.options = options
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # print file names byte for byte
    try:
        from . import commands

        name = arguments.command + "_" * keyword.iskeyword(arguments.command)
        return getattr(commands, name)(arguments) or 0
    except KeyboardInterrupt:
        print("\nfiretwin: stopped; finished files stay", file=sys.stderr)
        return 130
    except BrokenPipeError:  # such as `firetwin info RUN | head`
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
    """Format the help line of each pass."""
    from .shot import passes

    return "\n".join(f"  {name:<13}{text}" for name, text in passes.helps().items())


def _report(error: Exception) -> int:
    """Print an error with its remedy in one line; returns the exit status."""
    from .errors import DISK_FULL, Error, UsageError, disk_is_full
    from .progress import say

    if isinstance(error, UsageError):
        say(str(error))
        return 2
    if isinstance(error, Error):
        text = str(error)
    elif isinstance(error, OSError) and disk_is_full(error):
        text = f"{error.filename2 or error.filename or 'output or temporary files'}: {DISK_FULL}"
    elif isinstance(error, OSError) and error.filename:
        text = f"{error.filename}: {error.strerror}"
    elif isinstance(error, ModuleNotFoundError) and error.name == "bpy":
        text = "Blender's Python module (bpy) is missing; install it with: pip install 'firetwin[blender]'"
    elif isinstance(error, ModuleNotFoundError) and error.name == f"{__package__}.bench":
        text = "Blender's extension has no benchmarks; run them from a checkout (see the README)"
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
        epilog=help_texts.EPILOG,
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

    sample = command("sample", "write the synthetic King-like sample run", help_texts.SAMPLE)
    sample.add_argument("out", metavar="OUT", type=types.path, help="output folder; created if missing")
    sample.add_argument(
        "--frames", metavar="N", type=types.count, help="number of model times, evenly spread (all)"
    )
    sample.add_argument(
        "--format", choices=("npy", "text"), default="npy", help="format of field files (npy)"
    )
    sample.add_argument(
        "--pace",
        metavar="FACTOR",
        type=types.factor,
        default=1.0,
        help="factor of the rate of spread, for a what-if run (1)",
    )
    sample.add_argument(
        "--members", metavar="N", type=types.count, help="write a synthetic ensemble of N members instead"
    )
    sample.add_argument(
        "--member", metavar="I", type=types.count, default=0, help="write the run of member I of it (0)"
    )

    info = command("info", "list the content of a run", help_texts.INFO)
    info.add_argument(
        "run", metavar="RUN", type=types.path, help="run or ensemble folder, or a scene file for all its runs"
    )
    info.add_argument("--json", action="store_true", help="write JSON")

    cite = command("cite", "list the sources to cite with a run or a film", help_texts.CITE)
    cite.add_argument("run", metavar="RUN", type=types.path, help="run or ensemble folder, or a scene file")
    cite.add_argument("--json", action="store_true", help="write JSON")
    cite.add_argument(
        "--crate",
        metavar="DIR",
        type=types.path,
        help="write an RO-Crate of the film in DIR, a folder of render",
    )
    cite.add_argument(
        "--license", metavar="URL", default="", dest="licence", help="licence of the film, for --crate"
    )

    made = command("convert", "convert a fire model's output to a run", help_texts.CONVERT)
    made.add_argument(
        "paths",
        metavar="IN",
        nargs="+",
        type=types.path,
        help="output files of the model, or folders of them",
    )
    made.add_argument("--out", metavar="RUN", type=types.path, required=True, help="run folder to write")
    _add_origin(made)
    made.add_argument(
        "--interval",
        metavar="SECONDS",
        type=types.count,
        default=0,
        help="time step of the fields if the model writes arrival times (fitted)",
    )
    made.add_argument("--name", default="", help="name of the run (name of the folder and model)")
    made.add_argument(
        "--members",
        action="store_true",
        help="convert all members of a forecast to an ensemble (a model's output, a folder or list of runs)",
    )
    made.add_argument(
        "--member", metavar="NAME", default="", help="convert a member of the ensemble IN to a run"
    )
    made.add_argument(
        "--wind",
        metavar="GRIB2",
        nargs="+",
        type=types.path,
        default=[],
        help="forecast of HRRR for the wind at 10 m, if the model writes none: a file per hour",
    )
    made.add_argument(
        "--horizon",
        metavar="HOURS",
        type=types.hours,
        default=0,
        help="length of the forecast of --members (of its longest member)",
    )
    zone = "time zone of printed times, such as Europe/Paris (offset of --start, otherwise by longitude)"
    made.add_argument("--zone", default="", help=zone)

    watch = command("watch", "convert the output of a model that is still running", help_texts.WATCH)
    watch.add_argument(
        "run",
        metavar="RUN",
        nargs="+",
        type=types.path,
        help="file or folder that the model writes; then further files, such as a mapping",
    )
    watch.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder to write")
    watch.add_argument(
        "--every", metavar="SECONDS", type=types.count, default=5, help="time between polls, s (5)"
    )
    watch.add_argument(
        "--end",
        metavar="TIME",
        type=types.moment,
        help="last model time, such as 2014-09-17T16:00-07:00 (from the log of the model)",
    )
    watch.add_argument(
        "--idle",
        metavar="SECONDS",
        type=types.count,
        default=0,
        help="end if the files have not changed for this time, s (never)",
    )
    _add_origin(watch)
    watch.add_argument("--name", default="", help="name of the run (name of the folder and model)")
    watch.add_argument("--zone", default="", help=zone)

    new = command("new", "write a short scene file that fits a run", help_texts.NEW)
    new.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    new.add_argument(
        "-o", "--out", metavar="SCENE.toml", type=types.path, required=True, help="file to write"
    )
    for name, word in (("start", "first"), ("end", "last")):
        text = f"model time of the {word} frame, such as 2014-09-17T16:00-07:00 (fitted)"
        new.add_argument(f"--{name}", metavar="TIME", type=types.moment, help=text)
    new.add_argument("--overwrite", action="store_true", help="replace an existing file")

    maps = command("maps", "draw maps of the fuel load and of the maximum heat flux", help_texts.MAPS)
    maps.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    maps.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder for the PNG files")

    maps.add_argument(
        "--against",
        metavar="FILE",
        nargs="+",
        default=[],
        help="observed perimeters to draw (RUN/observations)",
    )

    haze = command("haze", "read the smoke of a weather forecast for a scene's haze", help_texts.HAZE)
    haze.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    haze.add_argument(
        "forecast", metavar="GRIB2", nargs="+", type=types.path, help="files of HRRR, one per hour"
    )
    haze.add_argument(
        "--time",
        metavar="TIME",
        type=types.moment,
        help="time of the scene, such as 2014-09-17T16:00-07:00 (the one nearest to mid-run)",
    )
    haze.add_argument(
        "--out", metavar="DIR", type=types.path, help="folder for a map of the smoke's column mass"
    )

    score = command("score", "score a run against observations of its fire", help_texts.SCORE)
    score.add_argument(
        "run",
        metavar="RUN",
        type=types.path,
        help="run folder, or a scene file, whose first run is scored against the second",
    )
    score.add_argument(
        "--against",
        metavar="FILE|RUN",
        nargs="+",
        default=[],
        help="observed perimeters, detections, or another run (RUN/observations)",
    )
    score.add_argument(
        "--report",
        metavar="X.html",
        type=types.path,
        help="write an HTML report with maps and curves (none)",
    )
    score.add_argument("--json", action="store_true", help="write JSON")

    if optional_features.is_installed("brief"):
        from .brief import arguments as brief

        brief.add(
            command("brief", "write a briefing page of a run", brief.DETAIL),
            types.path,
            types.size,
            types.name,
            types.moment,
        )

    imager = command("imager", "simulate a satellite imager's measurements of a run", help_texts.IMAGER)
    imager.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    imager.add_argument(
        "--out", metavar="DIR", type=types.path, required=True, help="folder for the GeoTIFF files"
    )
    imager.add_argument("--instrument", choices=("abi", "viirs"), default="abi", help="instrument (abi)")
    imager.add_argument(
        "--longitude",
        metavar="DEG",
        type=types.longitude,
        default=-137.0,
        help="longitude of the geostationary satellite of abi, degrees east (-137)",
    )
    imager.add_argument(
        "--every",
        metavar="SECONDS",
        type=types.count,
        default=900,
        help="model time between pictures, s (900)",
    )

    build = command("build", "build the scene and save it as a .blend file", help_texts.BUILD)
    _scene(build)
    build.add_argument("-o", "--out", metavar="X.blend", type=types.path, required=True, help="file to write")
    build.add_argument(
        "--run", metavar="NAME", type=types.name, help="name of the run of [[runs]] (the first run)"
    )
    build.add_argument(
        "--volumes", action="store_true", help="also write the smoke volumes of all frames, for a farm"
    )
    build.add_argument(
        "--live",
        action="store_true",
        help="also build the live scene, for headsets, and show it",
    )
    tiles.add_access(build)

    bake = command("bake", "prepare smoke for render, or write smoke volumes", help_texts.BAKE)
    _scene(bake)
    bake.add_argument(
        "--volumes", action="store_true", help="write the smoke volumes that a .blend file of build shows"
    )
    bake.add_argument(
        "--frames", metavar="LIST", help="frames of these volumes, such as 1-10 (all that cameras film)"
    )

    render = command("render", "render pictures and films", help_texts.RENDER.format(passes=_passes()))
    _scene(render)
    render.add_argument(
        "--out", metavar="DIR", type=types.path, required=True, help="folder for the pictures"
    )
    render.add_argument(
        "--frames",
        metavar="LIST",
        help="frames of each camera, such as 1-10, 3,5-9 or 1-48:4 (all)",
    )
    render.add_argument(
        "--camera",
        metavar="NAME",
        type=types.name,
        help="name of a camera (all); drone@RUN for one run",
    )
    render.add_argument(
        "--passes", metavar="LIST", help="passes, such as rgb,thermal (passes of the scene file)"
    )
    render.add_argument(
        "--resume",
        action="store_true",
        help="keep finished pictures whose settings and inputs have not changed",
    )
    render.add_argument(
        "--follow",
        action="store_true",
        help="render each frame when the next model time of a growing run exists (see watch)",
    )
    render.add_argument(
        "--preset",
        choices=types.OUTPUT_PRESETS,
        help="settings of EXR files and films for post-production (from the scene file)",
    )
    render.add_argument("--json", action="store_true", help="write JSON: files and memory")
    tiles.add_access(render)

    if optional_features.is_installed("dataset"):
        from .dataset import arguments as dataset

        dataset.add(command("dataset", "make labelled training data from a plan", dataset.DETAIL), types.path)
    if optional_features.is_installed("delivery"):
        from .delivery import arguments as delivery

        delivery.add(
            command("deliver", "copy finished files into a version folder", delivery.DETAIL),
            types.path,
            types.count,
        )
    if optional_features.is_installed("edit"):
        from .edit import arguments as edit

        editor = command("edit", "cut films into OTIO, Final Cut Pro XML and EDL files", edit.DETAIL)
        _scene(editor)
        edit.add(editor, types.path, types.name)
    if optional_features.is_installed("export"):
        from .export import arguments as export

        exporter = command("export", "write a scene for other programs", export.DETAIL)
        _scene(exporter)
        export.add(exporter, types.path, types.undulation)
    if optional_features.is_installed("farm"):
        from .farm import arguments as farm

        farm.add(
            command("farm", "plan a film for a render farm", farm.DETAIL),
            types.path,
            types.count,
        )
    if optional_features.is_installed("camera_import"):
        from .camera_import import arguments as camera_import

        camera_import.add(
            command("import", "add cameras of USD, Alembic, KML and GPX files", camera_import.DETAIL),
            types.path,
            types.name,
            types.undulation,
        )
    tiles.add(command("tiles", "read and make 3D tilesets", tiles.DETAIL), types.path, types.count)
    if optional_features.is_installed("allocation"):
        from .allocation import arguments as allocation

        summary = "suggest an allocation of resources (exercise)"
        allocation.add(
            command("allocate", summary, allocation.DETAIL),
            types.path,
            types.count,
            types.moment,
        )

    track = command("track", "write a camera's path as a GPX track", help_texts.TRACK)
    _scene(track)
    track.add_argument("--camera", metavar="NAME", type=types.name, help="name of the camera (the first)")
    track.add_argument("--out", metavar="FILE.gpx", type=types.path, required=True, help="file to write")

    cache = command(
        "cache", "list cached smoke volumes and tiles, or remove the least recently used", help_texts.CACHE
    )
    cache.add_argument(
        "places",
        metavar="SCENE|DIR",
        nargs="*",
        type=types.path,
        help="scene files or cache folders (./cache)",
    )
    cache.add_argument("--prune", action="store_true", help="remove the least recently used")
    cache.add_argument(
        "--limit",
        metavar="SIZE",
        type=types.size,
        default=types.size("20GB"),
        help="size of the cache after --prune, such as 500MB (20GB)",
    )
    cache.add_argument(
        "--answers",
        metavar="SIZE",
        type=types.size,
        default=types.size("4GB"),
        help="size of cached tile server responses after --prune (4GB)",
    )
    cache.add_argument(
        "--dry-run", action="store_true", help="list what --prune would remove; remove nothing"
    )

    stations.add_stations(
        command("stations", "make or list a station file", stations.STATIONS),
        types.path,
    )
    stations.add_resources(
        command("resources", "list resources that match a query", stations.RESOURCES),
        types.path,
        types.moment,
    )

    assets = command(
        "assets", "write an asset library of trees, materials and node groups", help_texts.ASSETS
    )
    assets.add_argument(
        "scene", metavar="SCENE.toml", nargs="?", type=types.path, help="scene file (sample run)"
    )
    assets.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder of the library")

    gpu = command("gpu", "list GPUs, or prepare their kernels", help_texts.GPU)
    form = gpu.add_mutually_exclusive_group()
    form.add_argument("--warm", action="store_true", help="compile the kernels into the driver's cache")
    form.add_argument(
        "--kernels",
        metavar="ARCH",
        type=types.architecture,
        help="make Cycles' kernels for an NVIDIA architecture, such as sm_90; needs no GPU",
    )

    command("schema", "print the JSON Schema of scene files, for TOML editors", help_texts.SCHEMA)

    bench = command("bench", "benchmark run time and error against alternatives", help_texts.BENCH)
    bench.add_argument(
        "--runs",
        metavar="N",
        type=types.count,
        default=1,
        help="number of repeated benchmarks, for ranges (1)",
    )
    form = bench.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="write JSON")
    form.add_argument("--markdown", action="store_true", help="write Markdown tables")
    return parser


def _add_origin(parser: argparse.ArgumentParser) -> None:
    """Add options for the start time and the place of a model's output."""
    parser.add_argument(
        "--start", metavar="TIME", default="", help="start time of the run, if the files do not give it"
    )
    parser.add_argument(
        "--at", metavar="LAT,LON", default="", help="centre of a grid without geographic coordinates"
    )
    parser.add_argument(
        "--projection",
        metavar="CRS",
        default="",
        help="coordinate reference system of grids in metres, such as EPSG:5070",
    )


def _scene(
    parser: argparse.ArgumentParser, help: str = "scene file, or run folder: settings are fitted to the run"
) -> None:
    parser.add_argument("scene", metavar="SCENE|RUN", type=types.path, help=help)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        super().error(escaped(message))


class _Version(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        import firetwin_core

        libraries = ", ".join(f"{name} {version}" for name, version in firetwin_core.build_info().items())
        print(f"firetwin {firetwin_core.__version__} ({libraries})")
        parser.exit()
