"""What building a part of a long film costs, and how far two parts differ where they meet.

    python tests/benchmarks/chunks.py RUN --work DIR

A drone hovers over the run of which RUN is the folder, all of its hours in 10,000 frames. `alone`: 250 of
these frames, as a film of their own with that one camera. `part`: the same 250 of the film of 20 such
cameras. Then a frame is rendered as the last of one part and as the first of the next, without smoke:
the mean FLIP (flip-evaluator) between them, and between two grains of the same part. Seconds are of the
processor; memory is the most that the process held; both with Blender's own.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from datetime import timedelta
from pathlib import Path

import numpy as np

FRAMES, FIRST, COUNT, CAMERAS = 10_000, 6000, 250, 20
LONGER = 353  # 17 such parts end with the frame after FIRST
SCENE = """run = "{run}"
cache = "{work}/cache"
[time]
start = {start}
end = {end}
frames = {frames}
[smoke]
enabled = false
[render]
resolution = [320, 180]
samples = 16
chunk = {chunk}
"""
CAMERA = """[[cameras]]
name = "{}"
kind = "drone"
[[cameras.keys]]
latitude = 38.977
longitude = -120.572
height = 400.0
target = "fire"
"""


def build(scene: Path, frame: int, picture: Path | None = None, seed: int = 0) -> dict[str, float]:
    """Build the part of the first camera that holds a frame, and render it; cpu-s and MB of the building."""
    import bpy
    from firetwin import memory
    from firetwin.bench.timing import Stopwatch
    from firetwin.jobs import render, worker_scene
    from firetwin.render.picture import Picture
    from firetwin.shot.source import ShotSource

    watch = Stopwatch()
    shot = ShotSource(str(scene)).shot()
    ((part, _),) = render._parts(
        shot.for_camera(shot.settings.cameras[0].name), [Picture(shot.settings.cameras[0].name, frame, "rgb")]
    )
    stage = worker_scene.build_scene(part, lambda *_: None, lambda _: None)
    found = {
        "cpu-s": watch.read().processor,
        "MB": memory.peak() / 2**20,
    }
    if picture:
        stage.scene.camera, stage.scene.cycles.seed = stage.camera(shot.settings.cameras[0].name), seed
        stage.scene.render.filepath = str(picture)
        stage.scene.frame_set(frame)
        bpy.ops.render.render(write_still=True, scene=stage.scene.name)
    return found


def scenes(run: Path, work: Path) -> None:
    """Write the scene files."""
    from firetwin.run import times
    from firetwin_core import run as runs

    opened = runs.open(run)
    step = (float(opened.times[-1]) - float(opened.times[0])) / (FRAMES - 1)
    begin = times.utc(opened, float(opened.times[0]))
    ends = {
        "part": (0, FRAMES - 1, FRAMES, CAMERAS),
        "alone": (FIRST, FIRST + COUNT - 1, COUNT, 1),
    }
    for name, (first, last, frames, cameras) in ends.items():
        start, end = ((begin + timedelta(seconds=at * step)).isoformat() for at in (first, last))
        text = SCENE.format(run=run.absolute(), work=work, start=start, end=end, frames=frames, chunk=COUNT)
        text += "".join(CAMERA.format(f"c{i}") for i in range(cameras))
        (work / f"{name}.toml").write_text(text)


def main() -> None:
    """Print the rows."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--one", nargs=4, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        scene, frame, picture, seed = given.one
        print(json.dumps(build(Path(scene), int(frame), Path(picture) if picture else None, int(seed))))
        sys.stdout.flush()
        import os

        os._exit(0)
    work = given.work.absolute()
    work.mkdir(parents=True, exist_ok=True)
    scenes(given.run, work)

    def one(name: str, frame: int, picture: str = "", seed: int = 0) -> dict[str, float]:
        where = str(work / picture) if picture else ""
        command = [sys.executable, __file__, str(given.run), "--work", str(work), "--one"]
        said = subprocess.run(
            [*command, str(work / f"{name}.toml"), str(frame), where, str(seed)],
            check=True,
            capture_output=True,
            text=True,
        )
        return json.loads(next(line for line in said.stdout.splitlines() if line.startswith("{")))

    for name, frame in (("alone", 1), ("part", FIRST + 1)):
        print(f"{name:8}" + "".join(f"{value:10.1f} {unit}" for unit, value in one(name, frame).items()))
    # The same film in longer parts: there the frame ends one, that begins one in the other.
    text = (work / "part.toml").read_text()
    (work / "longer.toml").write_text(text.replace(f"chunk = {COUNT}", f"chunk = {LONGER}"))
    for row, name, seed in (("first", "part", 0), ("last", "longer", 0), ("grain", "longer", 1)):
        one(name, FIRST + 1, f"{row}.png", seed)
    print(f"where parts meet: mean FLIP {_flip(work, 'first', 'last'):.3f}", end=", ")
    print(f"of another grain alone {_flip(work, 'last', 'grain'):.3f}")


def _flip(work: Path, one: str, other: str) -> float:
    import flip_evaluator

    paths = (str(work / f"{name}.png") for name in (one, other))
    return float(np.mean(flip_evaluator.evaluate(*paths, "LDR")[1]))


if __name__ == "__main__":
    main()
