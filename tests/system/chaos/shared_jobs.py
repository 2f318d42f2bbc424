"""Work that several processes share, and the files that each must leave: renders, farms, tiles, doors."""

from __future__ import annotations

import functools
import http.server
import json
import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import growing_model
from firetwin import written
from firetwin.run.content import sha256
from process import run
from scene_text import NO_SMOKE

SCENE = """\
run = "{run}"
{tiles}
[time]
start = 2014-09-17T21:00:00Z
end = 2014-09-17T21:02:00Z
frames = 6
shutter = 0.0
[terrain]
near_radius = 0.0
apron = 5000.0
[forest]
trees = false
grass = false
[render]
resolution = [64, 36]
samples = 1
denoise = false
passes = ["rgb", "depth"]
chunk = 2
[[cameras]]
name = "drone"
keys = [{{latitude = 38.825, longitude = -120.56, height = 400, target = "fire"}}]
"""
PREVIEW = '[smoke]\nmethod = "preview"\nspin_up = 60.0\nvoxel_size = 120.0\n'
FLOW = '[smoke]\nmethod = "flow"\ncell_budget = 0.1\nspin_up = 60.0\nvoxel_size = 150.0\n'
TILES = 'tiles = {{ sources = ["{url}/tileset.json"], max_screen_space_error = 1.0, geoid = -24.9 }}'
RENDER = "render {place}/scene.toml --out {place}/out --resume"


PLAN = """\
count = 2
seed = 3
moments = 1
sites = 2
resolution = [64, 64]
[[runs]]
place = "Place"
run = "run"
"""

Contents = dict[str, str]


def folder(out: Path, *left_out: str) -> Contents:
    """SHA-256 of every file of a folder, also of unfinished ones; without names that begin as `left_out`."""
    paths = [path for path in sorted(out.rglob("*")) if path.is_file() and path.name != written.NAME]
    names = {path: path.relative_to(out).as_posix() for path in paths}
    return {name: sha256(path) for path, name in names.items() if not name.startswith(left_out)}


def film(out: Path) -> Contents:
    """Content of a film.

    The order of entries changes the store, an encoder may write the same pictures in other bytes, and a farm
    adds a folder. The manifest tells what films are made of, and how long frames took.
    """
    manifest = json.loads((out / "manifest.json").read_text())
    manifest.pop("processor_seconds", None)
    found = folder(out, "farm/", "store.sqlite")
    for path, entry in manifest["files"].items():
        if path.endswith(".mp4"):
            del entry["bytes"], entry["sha256"]
    films = {name: "" for name in found if name.endswith(".mp4")}
    return found | films | {"manifest.json": json.dumps(manifest, sort_keys=True)}


def versions(out: Path) -> Contents:
    """Content of a version of a delivery: all versions must be equal, and the link must lead to the last."""
    paths = sorted(out.glob("v[0-9]*"))
    contents = [folder(path, "manifest.json") for path in paths]
    different = {path.name: "" for path, each in zip(paths, contents, strict=True) if each != contents[0]}
    newest = {"latest": str((out / "latest").readlink() == Path(paths[-1].name))}
    return folder(out, "v") | contents[0] | different | newest


def watched(out: Path) -> Contents:
    """Content of the last run of a watch, unfinished files, and all times but those of acceptance."""
    found, last = folder(out), max(out.glob("generation_*/*")).relative_to(out).as_posix()
    times = [
        (each["generation"], each["time"], each["sha256"])
        for each in json.loads((out / "times.json").read_text())
    ]
    kept = {name: value for name, value in found.items() if name.startswith(last) or ".part" in name}
    return kept | {"times.json": json.dumps(times)}


def data_set(out: Path) -> Contents:
    """Content of a data set without its leases and costs."""
    return folder(out, ".work/")


@dataclass
class Job:
    """Work that processes share.

    Attributes
    ----------
    scene
        Text of the scene file, or of the plan.
    work
        Arguments of `firetwin`; several processes run it at the same time.
    before, after
        Arguments of one process before and after it.
    watch
        Arguments of a process that only reads.
    plain
        Arguments of one process that leaves the same files undisturbed; empty: those of `work`.
    inputs
        Folders that are copied beside the scene file.
    contents
        Content of the output folder that must not differ.
    mixed
        Another version may take part.
    wanted
        That content, undisturbed.
    seconds
        Duration of the undisturbed work.
    """

    name: str
    scene: str
    work: str = RENDER
    before: str = ""
    after: str = ""
    watch: str = "cache {place}/cache"
    plain: str = ""
    inputs: dict[str, Path] = field(default_factory=dict)
    contents: Callable[[Path], Contents] = film
    mixed: bool = True
    wanted: Contents = field(default_factory=dict)
    seconds: float = 0.0

    def prepare(self, place: Path) -> None:
        """Write the scene file and its inputs to a new folder; its cache is in the same folder."""
        for name in ("cache", "tmp"):
            (place / name).mkdir(parents=True)
        (place / "scene.toml").write_text(self.scene)
        for name, source in self.inputs.items():
            shutil.copytree(source, place / name)

    def work_undisturbed(self, place: Path) -> None:
        """Do the work once, and note the files and the duration."""
        self.prepare(place)
        begun = time.monotonic()
        run(self.plain or self.work, place)
        self.seconds = time.monotonic() - begun
        self.wanted = self.contents(place / "out")


def all_jobs(run_folder: Path, place: Path) -> list[Job]:
    """Do the work of each job undisturbed in `place`."""
    ground = SCENE.format(run=run_folder, tiles="")
    (place / "ground.toml").write_text(ground + NO_SMOKE)
    run("tiles make {place}/ground.toml --out {place}/set --credit Nobody --geoid -24.9", place)
    tiles = TILES.format(url=serve(place / "set"))
    jobs = [
        Job("render", ground + PREVIEW),
        Job(
            "farm",
            ground + FLOW,
            before="farm {place}/scene.toml --engine slurm --out {place}/out --chunk 2",
            work="farm task {place}/out 1-4",
            after="farm assemble {place}/out",
            watch="farm status {place}/out",
            plain=RENDER,
        ),
        Job("tiles", SCENE.format(run=run_folder, tiles=tiles) + NO_SMOKE),
        export(run_folder),
        deliver(place / "render" / "out"),
        watch(place / "model"),
        dataset(run_folder),
        story(run_folder),
    ]
    for job in jobs:
        job.work_undisturbed(place / job.name)
    return jobs


def export(run_folder: Path) -> Job:
    """Several files of a scene for other programs."""
    work = "export {place}/scene.toml --to gis --geoid -24.9 --out {place}/out"
    return Job("export", SCENE.format(run="run", tiles=""), work, inputs={"run": run_folder}, contents=folder)


def deliver(film_folder: Path) -> Job:
    """Versions of a film."""
    work = "deliver {place}/film --out {place}/out"
    return Job("deliver", "", work, inputs={"film": film_folder}, contents=versions)


def watch(model: Path) -> Job:
    """A watch of a model that has ended."""
    model.mkdir()
    writer = growing_model.Writer(model / "fire.nc", "netcdf3")
    for _ in range(4):
        writer.append()
    writer.close()
    work = "watch {place}/model --every 1 --idle 2 --out {place}/out"
    return Job("watch", "", work, inputs={"model": model}, contents=watched)


def dataset(run_folder: Path) -> Job:
    """Two samples; a data set records the number of the version that began it."""
    work = "dataset {place}/scene.toml --out {place}/out"
    return Job("dataset", PLAN, work, inputs={"run": run_folder}, contents=data_set, mixed=False)


def story(run_folder: Path) -> Job:
    """A storyboard with its captions."""
    work = "story {place}/run --storyboard --out {place}/out"
    return Job("story", "", work, inputs={"run": run_folder}, contents=folder)


def serve(folder: Path) -> str:
    """Serve a folder on this machine, for caches; returns its URL."""

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def end_headers(self) -> None:
            self.send_header("Cache-Control", "max-age=60")
            super().end_headers()

        def log_message(self, *_: object) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder))
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}"
