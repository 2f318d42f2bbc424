"""Jobs that several processes share, and the files that each must leave: renders, a farm's tasks, tiles."""

from __future__ import annotations

import functools
import http.server
import json
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

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


@dataclass
class Job:
    """Work that processes share.

    Attributes
    ----------
    scene
        Text of the scene file.
    work
        Arguments of `firetwin`; several processes run it at the same time.
    before, after
        Arguments of one process before and after it.
    watch
        Arguments of a process that only reads.
    wanted
        Content of every file of an undisturbed render (see `contents`).
    seconds
        Duration of that render.
    """

    name: str
    scene: str
    work: str = RENDER
    before: str = ""
    after: str = ""
    watch: str = "cache {place}/cache"
    wanted: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0

    def prepare(self, place: Path) -> None:
        """Write the scene file to a new folder; its cache is in the same folder."""
        for name in ("cache", "tmp"):
            (place / name).mkdir(parents=True)
        (place / "scene.toml").write_text(self.scene)

    def render(self, place: Path) -> None:
        """Render undisturbed, and note the files and the duration."""
        self.prepare(place)
        begun = time.monotonic()
        run(RENDER, place)
        self.seconds = time.monotonic() - begun
        self.wanted = contents(place / "out")


def contents(out: Path) -> dict[str, str]:
    """SHA-256 of every file of a film, also of unfinished ones that were left.

    The order of entries changes the store, an encoder may write the same pictures in other bytes, and a farm
    adds a folder. The manifest tells what films are made of.
    """
    manifest = json.loads((out / "manifest.json").read_text())
    for path, entry in manifest["files"].items():
        if path.endswith(".mp4"):
            del entry["bytes"], entry["sha256"]
    found = {"manifest.json": json.dumps(manifest, sort_keys=True)}
    for path in sorted(out.rglob("*")):
        name = path.relative_to(out).as_posix()
        if path.is_file() and name not in found and not name.startswith(("farm/", "store.sqlite")):
            found[name] = "" if name.endswith(".mp4") else sha256(path)
    return found


def all_jobs(run_folder: Path, place: Path) -> list[Job]:
    """Render each job undisturbed in `place`."""
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
        ),
        Job("tiles", SCENE.format(run=run_folder, tiles=tiles) + NO_SMOKE),
    ]
    for job in jobs:
        job.render(place / job.name)
    return jobs


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
