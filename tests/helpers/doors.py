"""Commands that write files for their user: a cheap call of each, and what becomes of the files in its way.

The work of a command (drawing, solving, Blender) is replaced by a few bytes; its writer is the real one. As a
script ``tests/unit/project/test_doors.py`` prints the table.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import io
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import growing_model
import labelled
import numpy as np
import pytest
from firetwin import cli, leases, output
from firetwin.dataset import produce
from firetwin.farm import plan
from firetwin.render import store
from firetwin.render.store import Store
from firetwin.run import content, readers
from firetwin.run.models import write
from small_run import RUN_TOML, small_fields, write_field

MINE = b"mine, of years\n"
SCENE = """\
run = "run"
cache = "cache"
[tiles]
geoid = -24.9
[[cameras]]
name = "drone"
keys = [{ latitude = 38.905, longitude = -120.59, height = 400, target = "fire" }]
"""

Patch = pytest.MonkeyPatch


@dataclass(frozen=True)
class Door:
    """A command line that writes files.

    Attributes
    ----------
    words
        Command line, or a call with further words; paths are relative to the current folder.
    outputs
        Files that it writes.
    prepare
        Makes its inputs, and replaces its work.
    """

    words: str | Callable[..., Call]
    outputs: tuple[str, ...]
    prepare: Callable[[Patch], object]


NO_DOORS = {
    "bake": "the cache of the scene file, by hashes",
    "bench": "nothing",
    "cache": "the cache, by hashes",
    "dataset check": "nothing",
    "farm assemble": "a film, as render",
    "farm cancel": "nothing",
    "farm resume": "a job that farm plan wrote",
    "farm status": "nothing",
    "farm task": "a film, as render",
    "gpu": "the cache of kernels, by hashes",
    "import": "cameras into a scene file, whose other lines stay",
    "info": "nothing",
    "resources": "nothing",
    "schema": "nothing",
    "stations info": "nothing",
    "tiles info": "nothing",
}
"""Commands that write no files of their own for the user, and what they write."""

FOLDERS: dict[str, tuple[str, Callable[[Path], object]]] = {
    "convert": ("out", lambda folder: write.check(folder / "out")),
    "farm plan": ("out/farm", lambda folder: plan.write(None, folder / "out")),
    "render": ("out/drone", lambda folder: store.refuse_others(folder / "out", ["drone"])),
}
"""Commands that write only into folders that are theirs or new: the folder, and its check."""


def verbs() -> dict[str, argparse.ArgumentParser]:
    """Return the parser of each verb of each command, by its words, such as ``dataset make``."""

    def walk(name: str, parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
        inner = [each for each in parser._actions if isinstance(each, argparse._SubParsersAction)]
        for word, choice in [pair for each in inner for pair in each.choices.items()]:
            yield from walk(f"{name} {word}".strip(), choice)
        if not inner:
            yield name, parser

    return dict(walk("", cli._parser(cli.find_commands())))


def _scene(patch: Patch) -> None:
    _run(patch)
    Path("scene.toml").write_text(SCENE)


def _run(_: Patch) -> None:
    Path("run").mkdir(exist_ok=True)
    Path("run/run.toml").write_text(RUN_TOML)
    for name, values in small_fields().items():
        write_field(Path("run"), name, values, "npy")


def _figure(*_: object) -> object:
    from matplotlib.figure import Figure

    return Figure(figsize=(0.1, 0.1))


def _brief(patch: Patch) -> None:
    from firetwin.brief import briefing, map_sheet, page, pdf, sheet_options

    _run(patch)
    gathered = SimpleNamespace(run=None, sheet=None, zone="UTC")
    patch.setattr(briefing, "gather", lambda _: gathered)
    patch.setattr(page, "notes", lambda _: [])
    patch.setattr(page, "html", lambda *_: "<html>")
    patch.setattr(pdf, "check", lambda *_: None)
    patch.setattr(pdf, "find_browser", lambda: "browser")
    patch.setattr(pdf, "_browse", lambda _, page, part, *options: part.write_bytes(b"printed"))
    patch.setattr(sheet_options.Titles, "of", lambda *_: SimpleNamespace(incident="", author=""))
    patch.setattr(map_sheet, "draw", lambda *_: None)
    patch.setattr(
        pdf,
        "write_geopdf",
        lambda sheet, title, author, path, overwrite: output.write_text(path, "sheet", overwrite),
    )


def _cite(patch: Patch) -> None:
    _scene(patch)
    hashes = content.inputs(readers.open(Path("run")), Path("cache"))
    _film({"versions": {"firetwin": "0", "blender": "0"}, "run": hashes})


def _film(made_with: dict) -> None:
    name, out = "drone/rgb/drone_rgb_000001.png", Path("film")
    (out / name).parent.mkdir(parents=True, exist_ok=True)
    (out / name).write_bytes(b"picture")
    entry = store.describe(out / name) | {"camera": "drone", "pass": "rgb", "frame": 1}
    with Store(out, create=True) as made:
        made.add(made_with, {name: entry})
        made.export()


def _haze(patch: Patch) -> None:
    from datetime import UTC, datetime

    from firetwin.run import maps
    from firetwin.shot.light import smoke_forecast

    _run(patch)
    Path("hrrr.grib2").touch()
    moment = datetime(2014, 9, 17, 5, tzinfo=UTC)
    smoke = SimpleNamespace(valid=moment, issued=moment, column=None)
    patch.setattr(smoke_forecast, "read", lambda *_: [smoke])
    patch.setattr(smoke_forecast, "page", lambda *_: "")
    patch.setattr(maps, "smoke_map", _figure)


def _imager(patch: Patch) -> None:
    from firetwin.shot.satellites import imager

    _run(patch)
    grid = SimpleNamespace(corner=lambda *_: (0.0, 0.0), step=(1.0, -1.0), crs="EPSG:32610")
    layers = dict.fromkeys(("short", "long", "power", "mask"), np.zeros((2, 2)))
    picture = SimpleNamespace(**layers, grid=grid, row=0, column=0, heat=0.0, limited=0)
    patch.setattr(imager, "film", lambda *_: iter([(0.0, picture)]))


def _maps(patch: Patch) -> None:
    from firetwin.run import maps

    _run(patch)
    patch.setattr(maps, "fuel_map", _figure)
    patch.setattr(maps, "intensity_map", _figure)


def _sample(patch: Patch) -> None:
    from firetwin.data import sample

    patch.setattr(sample, "MODEL_CELLS", 2)
    patch.setattr(sample.members, "sample_of", lambda _: None)
    patch.setattr(sample, "_static", lambda *_: {"latitude": np.zeros(2)})
    patch.setattr(
        sample, "frames_of", lambda _, minutes: (tuple(np.zeros((4, 2, 2), np.float32)) for _ in minutes)
    )


def _score(patch: Patch) -> None:
    from firetwin.run import observations
    from firetwin.run import score as scores
    from firetwin.run.score import page, report, used

    _run(patch)
    patch.setattr(observations, "read", lambda _: SimpleNamespace(heat=(), perimeters=(), detections=()))
    patch.setattr(scores, "score", lambda *_, **__: {"uses": []})
    patch.setattr(page, "page", lambda _: "")
    patch.setattr(used, "nothing", lambda _: "")
    patch.setattr(report, "html", lambda *_: "<html>")


def _watch(patch: Patch) -> None:
    from firetwin.growing import watch

    patch.setenv("HDF5_USE_FILE_LOCKING", "FALSE")
    if not Path("model").is_dir():
        Path("model").mkdir()
        model = growing_model.Writer(Path("model/fire.nc"), "netcdf3")
        model.append()
        model.append()
        model.close()
    patch.setattr(watch.worker, "run", lambda work, **_: work())
    patch.setattr(watch, "run", functools.partial(watch.run, wait=lambda _: None, polls=1))


def _allocate(patch: Patch) -> None:
    from firetwin.allocation import job, page, read

    _run(patch)
    suggestion = {"map": {}, "left_out": [], "reasons": []}
    patch.setattr(read, "read", lambda *_: ([], []))
    patch.setattr(job, "default_order_time", lambda _: 0.0)
    patch.setattr(job, "suggest", lambda *_, **__: dict(suggestion))
    patch.setattr(page, "format_text", lambda *_: "")


def _no_work(patch: Patch, out: Path) -> None:
    """Replace the worker of Blender by one that saves a .blend file."""
    from firetwin import unfinished
    from firetwin.jobs import build, worker
    from firetwin.jobs.tiles import imagery, selection
    from firetwin.shot.source import ShotSource

    def save(*_: object, **__: object) -> int:
        with unfinished.folder(out) as folder:
            (folder / out.name).write_bytes(b"BLENDER")
            output.publish_blend(folder / out.name, out.absolute())
        return 0

    _scene(patch)
    patch.setattr(ShotSource, "shot", lambda _: None)
    patch.setattr(worker, "run", save)
    for module in (imagery, selection):
        patch.setattr(module, "prepare", lambda *_, **__: None)
    assert build.worker is worker


def _new(patch: Patch) -> None:
    from firetwin.auto_framing import fitted_scene

    _run(patch)
    patch.setattr(fitted_scene, "fit_text", lambda *_: SCENE)


def _stations(_: Patch) -> None:
    Path("stations.csv").write_text("name,latitude,longitude\nA,38.9,-120.59\n")


def _tiles(patch: Patch) -> None:
    from firetwin.jobs.tiles import make
    from firetwin.tiles.make.tileset import TilesetSummary

    class Maker:
        def __init__(self, *words: object) -> None:
            self.out = words[3]

        def run(self, _: object) -> TilesetSummary:
            (self.out / "terrain").mkdir()
            (self.out / "terrain" / "0.glb").write_bytes(b"glTF")
            (self.out / "tileset.json").write_text('{"asset": {"generator": "Firetwin"}}')
            return TilesetSummary()

    _scene(patch)
    patch.setattr(make, "ground_surface", lambda *_: None)
    patch.setattr(make, "Lattice", lambda *_: None)
    patch.setattr(make, "_FuelColours", lambda _: None)
    patch.setattr(make, "Maker", Maker)


def _data_set(patch: Patch) -> None:
    patch.setattr(leases, "PATIENCE", 0.1)
    patch.setattr(produce, "_POLL_INTERVAL", 0.05)
    if not Path("set/meta").exists():
        labelled.data_set(Path("set"), 2)


def _make_set(patch: Patch) -> None:
    from firetwin.dataset import verbs

    _data_set(patch)
    estimate = SimpleNamespace(lines=lambda: [])
    patch.setattr(verbs, "prepare", lambda *_: SimpleNamespace(estimate=lambda: estimate))
    patch.setattr(verbs, "describe", lambda _: [])
    patch.setattr(verbs, "make", lambda *_: None)


def _deliver(_: Patch) -> None:
    _film({"run": {}})
    Path("versions/latest").mkdir(parents=True, exist_ok=True)  # so that a text names the latest version


def _edit(patch: Patch) -> None:
    from firetwin.cuts import cut, edl, fcp_xml, otio
    from firetwin.edit import markers, media

    _scene(patch)
    patch.setattr(media, "films", lambda *_: [])
    patch.setattr(cut, "cut", lambda _: [])
    patch.setattr(markers, "find", lambda _: [])
    for each in (otio, fcp_xml, edl):
        patch.setattr(each, "text", lambda _: "cut")


def _export(patch: Patch) -> None:
    from firetwin.export import formats

    def write(request: object) -> list[Path]:
        (request.folder / "maps").mkdir()
        (request.folder / "maps" / "fuel.tif").write_bytes(b"map")
        return [request.folder / "maps" / "fuel.tif"]

    _scene(patch)
    patch.setattr(formats, "writer", lambda _: write)


DOORS = {
    "allocate": Door("allocate stations.gpkg run --geojson out/map.geojson", ("out/map.geojson",), _allocate),
    "assets": Door(
        "assets scene.toml --out library",
        ("library/firetwin_assets.blend", "library/blender_assets.cats.txt"),
        lambda patch: _no_work(patch, Path("library/firetwin_assets.blend")),
    ),
    "brief": Door(
        "brief run --out out/page.html --pdf out/page.pdf --geopdf out/sheet.pdf",
        ("out/page.html", "out/page.pdf", "out/sheet.pdf"),
        _brief,
    ),
    "build": Door(
        "build scene.toml -o out/x.blend",
        ("out/x.blend",),
        lambda patch: _no_work(patch, Path("out/x.blend")),
    ),
    "cite": Door("cite scene.toml --crate film", ("film/ro-crate-metadata.json",), _cite),
    "dataset draw": Door("dataset draw set --out seen", ("seen/000001.png",), _data_set),
    "dataset formats": Door(
        "dataset formats set --format coco,yolo,hf",
        ("set/README.md", "set/data.yaml", "set/annotations/instances_train.json", "set/SHA256SUMS"),
        _data_set,
    ),
    "dataset make": Door("dataset plan.toml --out set", ("set/README.md", "set/report.html"), _make_set),
    "deliver": Door("deliver film --out versions", ("versions/latest.txt",), _deliver),
    "edit": Door("edit scene.toml --out cut", ("cut/film.otio", "cut/film.xml", "cut/film.edl"), _edit),
    "export": Door(
        "export scene.toml --to kmz --out there", ("there/maps/fuel.tif", "there/georeference.json"), _export
    ),
    "haze": Door("haze run hrrr.grib2 --out out", ("out/smoke_20140917T0500Z.png",), _haze),
    "imager": Door("imager run --out out", ("out/abi_20140917T0445Z.tif",), _imager),
    "maps": Door("maps run --out out", ("out/fuel.png", "out/intensity.png"), _maps),
    "new": Door("new run -o out/scene.toml", ("out/scene.toml",), _new),
    "sample": Door("sample out --frames 1", ("out/run.toml", "out/heat_flux.npy"), _sample),
    "score": Door("score run --report out/score.html", ("out/score.html",), _score),
    "stations exercise": Door("stations exercise run --out out/x.gpkg", ("out/x.gpkg",), _run),
    "stations import": Door("stations import stations.csv --out out/x.gpkg", ("out/x.gpkg",), _stations),
    "story": Door(
        "story run --out out --storyboard --for training",
        ("out/story.srt", "out/story.vtt", "out/story.json", "out/instructor.html"),
        _run,
    ),
    "tiles make": Door("tiles make scene.toml --out out", ("out/terrain/0.glb", "out/tileset.json"), _tiles),
    "track": Door("track scene.toml --out out/drone.gpx", ("out/drone.gpx",), _scene),
    "watch": Door("watch model --out out", ("out/times.json", "out/status.json", "out/index.html"), _watch),
}

Outcome = str
REPLACED, LOST = "replaced", "LOST"


@dataclass(frozen=True)
class Call:
    """A finished call: exit status, and its messages."""

    status: int
    said: str


def call(door: Door, *more: str) -> Call:
    """Run a command line in this process."""
    if not isinstance(door.words, str):
        return door.words(*more)
    words, said = door.words.split(), io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        status = cli.main([*words, *more])
    lines = [line for line in said.getvalue().splitlines() if line.startswith("firetwin: ")]
    return Call(status, lines[-1] if lines else "")


def outcome(done: Call, path: Path, before: bytes) -> Outcome:
    """Describe what a call did to a file of the user."""
    if path.is_file() and path.read_bytes() == before:
        if done.status == 0:
            return "stays"
        remedy = "; --overwrite" if "--overwrite" in done.said else ""
        names_it = any(part in done.said for part in path.parts)
        return f"refused{remedy}" if names_it and "unexpected" not in done.said else done.said
    if before in [each.read_bytes() for each in Path().rglob("*") if each.is_file()]:
        return "kept as .blend1"
    return REPLACED if done.status == 0 else LOST


def own(door: Door, path: Path) -> Outcome:
    """Call it twice."""
    call(door)
    before = path.read_bytes()
    done = call(door)
    return REPLACED if done.status == 0 and path.is_file() else f"{done.said} {len(before)}"


def changed(door: Door, path: Path) -> Outcome:
    """Change its file before the second call."""
    before = _change(door, path)
    return outcome(call(door), path, before)


def _change(door: Door, path: Path) -> bytes:
    call(door)
    path.write_bytes(path.read_bytes() + MINE)
    return path.read_bytes()


def asked(door: Door, path: Path) -> Outcome:
    """Change its file, and ask for the replacement."""
    before = _change(door, path)
    return outcome(call(door, *_request(path)), path, before)


def _request(path: Path) -> list[str]:
    return [] if path.suffix == ".blend" else ["--overwrite"]


def others(door: Door, path: Path) -> Outcome:
    """Put a file of others in its way."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(MINE)
    return outcome(call(door), path, MINE)


def folder(door: Door, path: Path) -> Outcome:
    """Put a folder with a file of others in its way."""
    path.mkdir(parents=True)
    (path / "mine.txt").write_bytes(MINE)
    return outcome(call(door), path / "mine.txt", MINE)


def neighbours(door: Door, path: Path) -> Outcome:
    """Put files of others beside its files after the first call."""
    call(door)
    there = path.parent / "mine.txt", path.parent / "mine" / "mine.txt"
    there[1].parent.mkdir()
    for each in there:
        each.write_bytes(MINE)
    done = call(door)
    return {outcome(done, each, MINE) for each in there}.pop()


def link(door: Door, path: Path) -> Outcome:
    """Put a link to a file outside of its folder in its way; on request, the link itself is replaced."""
    Path("outside").write_bytes(MINE)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.symlink_to(Path("outside").absolute())
    said = outcome(call(door), path, MINE)
    call(door, *_request(path))
    return said if Path("outside").read_bytes() == MINE else LOST


def protected(door: Door, path: Path) -> Outcome:
    """Protect its file against writing."""
    call(door)
    path.chmod(0o444)
    before = path.read_bytes()
    return outcome(call(door), path, before)


def full(door: Door, path: Path) -> Outcome:
    """Let no file grow in the second call, as on a full disk."""
    import resource  # not on Windows

    call(door)
    before, limits = path.read_bytes(), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, limits[1]))
    try:
        done = call(door)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    said = outcome(done, path, before)
    again = call(door)
    return f"{said}, then {outcome(again, path, before)}" if again.status else said


def killed(door: Door, path: Path) -> Outcome:
    """End the process before each renaming of a second call; the third call works."""
    call(door)
    before, steps = path.read_bytes(), 0
    while True:
        child = os.fork()
        if child == 0:
            _end_at(steps)
            call(door)
            os._exit(0)
        if os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0:
            break
        if not path.is_file():
            return LOST
        steps += 1
    done = call(door)
    rests = [*Path().rglob(".*.part*")]
    return REPLACED if done.status == 0 and path.is_file() and not rests and before else done.said


def _end_at(step: int) -> None:
    """End this process when it renames a file for the time `step`."""
    rename, left = Path.replace, iter(range(step))

    def replace(self: Path, target: Path) -> Path:
        if next(left, None) is None:
            os._exit(9)
        return rename(self, target)

    Path.replace = replace


STATES: dict[str, Callable[[Door, Path], Outcome]] = {
    "own": own,
    "own, changed": changed,
    "own, changed, --overwrite": asked,
    "another's file": others,
    "another's folder": folder,
    "others beside it": neighbours,
    "link": link,
    "write-protected": protected,
    "full disk": full,
    "killed": killed,
}


_ONCE = {"own", "own, changed, --overwrite", "others beside it", "full disk", "killed"}


def run(door: Door, state: str, path: str, folder: Path) -> Outcome:
    """Run a state of a door in an empty folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        door.prepare(patch)
        return STATES[state](door, Path(path))


def states(door: Door, path: str) -> list[str]:
    """List the states that are tried for a file; those of whole commands only for their first file."""
    return [state for state in STATES if state not in _ONCE or path == door.outputs[0]]


def table(doors: dict[str, Door]) -> Iterator[tuple[str, ...]]:
    """Rows: command, file, and the outcome of each state."""
    yield ("command or operator", "file", *STATES)
    for name, door in doors.items():
        for path in door.outputs:
            outcomes = dict.fromkeys(STATES, "as above")
            for state in states(door, path):
                place = Path(tempfile.mkdtemp())
                outcomes[state] = run(door, state, path, place)
                shutil.rmtree(place, ignore_errors=True)
            yield (name, path, *outcomes.values())


def print_table(doors: dict[str, Door]) -> None:
    """Print a line for each file of each door."""
    for row in table(doors):
        print(f"| {' | '.join(row)} |", flush=True)
