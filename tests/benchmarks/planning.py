"""Planning `firetwin render --frames 1` of a scene of 20 cameras and 10,000 frames: 600,000 pictures."""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path

from firetwin.bench.harness import OURS, Bench
from firetwin.bench.timing import Runner
from firetwin.data import sample
from firetwin.render import films, fingerprint, plan
from firetwin.render.picture import Picture
from firetwin.render.store import Store
from firetwin.shot.source import ShotSource

CAMERAS, FRAMES = 20, 10_000
FINISHED = 2000  # finished frames of every camera and pass
MODEL_TIMES = 3  # of the sample, as the run
LIMIT = 0.5  # s
CAMERA = """[[cameras]]
name = "camera{}"
keys = [{{latitude = 38.9, longitude = -120.55, height = 400, target = "fire"}}]
"""


def write_scene(folder: Path) -> Path:
    """Write the scene file and its run."""
    sample.write(folder / "run", MODEL_TIMES, "npy")
    cameras = "".join(CAMERA.format(i) for i in range(CAMERAS))
    scene = folder / "scene.toml"
    scene.write_text(f'run = "run"\n[time]\nframes = {FRAMES}\n{cameras}', encoding="utf-8")
    return scene


def missing(scene: Path, out: Path) -> int:
    """Plan as `firetwin render --frames 1` does before it starts Blender; count the missing pictures."""
    shot = ShotSource(scene=str(scene)).shot()
    wanted = plan.pictures(shot, "1")
    made_with = fingerprint.compute(shot, wanted)
    with Store(out) as store:
        pictures = plan.missing(store, wanted, made_with)
        any(films.missing(shot, store, made_with))
    return len(pictures)


def finish(scene: Path, out: Path, frames: int) -> int:
    """Record pictures of the first frames, and return their number; frame 1 gets files of one byte."""
    shot = ShotSource(scene=str(scene)).shot()
    wanted = plan.pictures(shot, f"1-{frames}")
    made_with = fingerprint.compute(shot, wanted)
    for picture in wanted:
        for path in picture.files() if picture.frame == 1 else ():
            (out / path).parent.mkdir(parents=True, exist_ok=True)
            (out / path).write_bytes(b".")
    with Store(out, create=True) as store:
        for pair, settings in made_with.items():
            entries = {
                path: {"bytes": 1, "sha256": "0" * 64, "camera": pair[0], "pass": pair[1], "frame": frame}
                for frame in range(1, frames + 1)
                for path in Picture(pair[0], frame, pair[1]).files()
            }
            store.add(settings, entries)
    return len(wanted)


def run(bench: Bench) -> None:
    """Plan for an empty folder, and for one in which a fifth is finished."""
    with tempfile.TemporaryDirectory() as name:
        scene, out = write_scene(Path(name)), Path(name) / "out"
        count = finish(scene, out, FINISHED)
        cases = {"nothing finished": Path(name) / "none", f"{count:,} pictures finished": out}
        for case, place in cases.items():
            times = bench.race(case, [Runner(OURS, partial(missing, scene, place))], 1, "plan")[OURS]
            bench.target(f"Time to plan one frame, {case}", times.seconds, LIMIT, "s", most=True)
