"""What a coarser mesh of the ground changes in pictures: vertices and seconds against mean FLIP.

    python tests/benchmarks/ground_pictures.py RUN OUT [--size 320] [--samples 8] [--errors 0.5 2] [--json]

A drone's picture and a satellite's of bare ground, without forest, smoke and fire, whose meshes may be off by
`terrain.error` pixels, against those with FINEST; and one with FINEST and other grain: a smaller
difference is not to be told from grain. Needs flip-evaluator (Andersson et al. 2020, doi
10.1145/3406183: 0 the same, 1 as different as black and white).
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path

import bpy
from firetwin.jobs.worker_scene import build_scene
from firetwin.scene.terrain import build
from firetwin.shot.settings import scene_file
from firetwin.shot.settings.settings import Settings
from firetwin.shot.shot import Shot
from firetwin_core import run as runs

FINEST = 0.01  # pixels
SCENE = """\
run = "{run}"
[time]
start = 2014-09-17T15:00:00-07:00
frames = 1
[forest]
trees = false
grass = false
[smoke]
enabled = false
[fire]
flames = false
embers = false
firebrands = 0
torches = false
[render]
resolution = [{width}, {height}]
samples = {samples}
denoise = false
passes = ["rgb"]
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.9741
longitude = -120.5777
height = 800.0
target = "point"
target_latitude = 38.99
target_longitude = -120.50
[[cameras]]
name = "satellite"
kind = "satellite"
"""


def settings(folder: Path, out: Path, size: int, samples: int) -> Settings:
    """The scene, its file written to `out`."""
    text = SCENE.format(
        run=folder.resolve().as_posix(), width=size, height=size * 9 // 32 * 2, samples=samples
    )
    out.mkdir(parents=True, exist_ok=True)
    (out / "scene.toml").write_text(text, encoding="utf-8")
    return scene_file.read(out / "scene.toml")


def drawn(shot: Shot, path: Path) -> tuple[int, float]:
    """Draw a shot's one camera; vertices of the ground, and seconds that its mesh took."""
    _ = shot.paths
    begin = time.perf_counter()
    build.shape(shot)
    seconds = time.perf_counter() - begin
    stage = build_scene(shot, lambda *_: None, print)
    stage.scene.render.filepath = str(path.resolve())
    bpy.ops.render.render(write_still=True)
    return len(bpy.data.objects["Firetwin Ground"].data.vertices), seconds


def main() -> None:
    """Draw, compare and print."""
    import flip_evaluator

    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--size", type=int, default=320)
    parser.add_argument("--samples", type=int, default=8)
    parser.add_argument("--errors", type=float, nargs="+", default=[0.05, 0.5, 2.0])
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    plain, run = settings(asked.run, asked.out, asked.size, asked.samples), runs.open(asked.run)
    rows = []
    for camera in plain.cameras:
        paths = {}
        for error, seed in ((FINEST, 0), (FINEST, 1), *((error, 0) for error in asked.errors)):
            ground, render = replace(plain.ground, error=error), replace(plain.render, seed=seed)
            own = replace(plain, cameras=(camera,), ground=ground, render=render)
            paths[error, seed] = asked.out / f"{camera.name}_{error:g}_{seed}.png"
            vertices, seconds = drawn(Shot(own, run), paths[error, seed])
            pair = (str(paths[FINEST, 0]), str(paths[error, seed]))
            flip = float(flip_evaluator.evaluate(*pair, "LDR")[1]) if len(paths) > 1 else 0.0
            named = {"camera": camera.name, "error": error, "grain": seed}
            rows.append(named | {"vertices": vertices, "s": seconds, "flip": flip})
    if asked.json:
        print(json.dumps(rows))
        return
    for row in rows:
        print(
            f"{row['camera']:10} {row['error']:5g} px, grain {row['grain']} {row['vertices']:9,} vertices "
            f"{row['s']:6.2f} s FLIP {row['flip']:.4f}"
        )


if __name__ == "__main__":
    main()
