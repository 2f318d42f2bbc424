"""Run time and memory against error of culling, for a drone, a lookout and a satellite.

    python tests/benchmarks/culling.py RUN --work DIR [--reach 1500] [--samples 16] [--views drone,lookout]

Every scene is rendered once in a process of its own with `render.cull = false`, which builds all that there
is, and at three settings with culling. Seconds are of the processor, memory the most that the process held,
both less what starting Blender takes. The error is the mean FLIP (Andersson and others 2020, package
flip-evaluator, its own 67 pixels per degree) against the picture of all, with the same grain; what another
grain alone makes of that, the row "all, other grain" shows. Without that package the error is the root of
the mean square, of 0 to 1. Trees stand within `--reach` metres of the cameras in all of the rows, and the
satellite sees those of Algorithm 2: as many as there are within the example's 12 km, or in all of the
domain, would not fit into memory.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SCENE = """run = "{run}"
cache = "{work}/cache"
[time]
start = 2014-09-17T16:12:00-07:00
end = 2014-09-17T16:12:01-07:00
frames = 1
[terrain]
error = {error}
[forest]
density = "{density}"
budget = {budget}
draw_distance = {reach}
[smoke]
enabled = false
[render]
resolution = [320, 180]
samples = {samples}
seed = {seed}
cull = {cull}
passes = ["rgb"]
[[cameras]]
name = "view"
{camera}
"""
KEY = """kind = "drone"
[[cameras.keys]]
latitude = {0}
longitude = {1}
height = {2}
target = "head"
"""
ABOVE = """kind = "satellite"
swath = 6000.0
[[cameras.keys]]
latitude = 38.99
longitude = -120.56
"""
CAMERAS = {
    "drone": KEY.format(38.977, -120.572, 150.0),
    "lookout": KEY.format(38.9741, -120.5777, 25.0),
    "satellite": ABOVE,
}
ALL = {"error": 0.05, "budget": 200_000, "cull": "false", "seed": 0}
"""Every tree, and the ground as fine as a twentieth of a pixel at 60 m wherever it is."""
ROWS = {
    "all": ALL,
    "all, other grain": ALL | {"seed": 1},
    "fine": {"error": 0.02, "budget": 1_000_000, "cull": "true", "seed": 0},
    "as it comes": {"error": 0.05, "budget": 200_000, "cull": "true", "seed": 0},
    "coarse": {"error": 0.5, "budget": 30_000, "cull": "true", "seed": 0},
}


def one(scene: Path, picture: Path) -> None:
    """Build and render a scene in this process; print seconds, MB, and how much there is in the scene."""
    import bpy
    from firetwin import memory
    from firetwin.bench.timing import Stopwatch
    from firetwin.jobs import worker_scene
    from firetwin.shot.source import ShotSource

    held, watch = memory.peak(), Stopwatch()
    stage = worker_scene.build_scene(ShotSource(str(scene)).shot(), lambda *_: None, lambda _: None)
    built = watch.read().processor
    stage.scene.camera = stage.camera("view")
    stage.scene.frame_set(1)
    stage.scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True, scene=stage.scene.name)
    meshes = {thing.name: len(thing.data.vertices) for thing in stage.scene.objects if thing.type == "MESH"}
    print(
        "FOUND "
        + json.dumps(
            {
                "build": built,
                "render": watch.read().processor - built,
                "MB": (memory.peak() - held) / 2**20,
                "trees": meshes.get("Firetwin Trees", 0),
                "ground": meshes.get("Firetwin Ground", 0),
            }
        )
    )


def scene_text(row: dict, camera: str, given: argparse.Namespace) -> str:
    """Scene file of one row from one camera."""
    return SCENE.format(
        camera=camera,
        density="paper" if "satellite" in camera else "stand",
        run=given.run.absolute(),
        work=given.work,
        reach=given.reach,
        samples=given.samples,
        **row,
    )


def measure(folder: Path, row: dict, camera: str, given: argparse.Namespace) -> tuple[dict, NDArray]:
    """What one row took, and its picture (height, width, 3), 0 to 1."""
    import matplotlib.image

    folder.mkdir(parents=True, exist_ok=True)
    scene, picture = folder / "scene.toml", folder / "picture.png"
    scene.write_text(scene_text(row, camera, given))
    command = [sys.executable, __file__, "--one", str(scene), str(picture)]
    told = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    found = next(line for line in told.splitlines() if line.startswith("FOUND "))
    return json.loads(found[6:]), matplotlib.image.imread(picture)[..., :3]


def error(reference: NDArray, picture: NDArray) -> float:
    """Mean FLIP, or the root of the mean square where that is not installed."""
    try:
        import flip_evaluator
    except ImportError:
        return float(np.sqrt(np.mean((reference - picture) ** 2)))
    return float(flip_evaluator.evaluate(reference, picture, "LDR")[1])


def main() -> None:
    """Measure all rows of all views and print them as a table."""
    if "--one" in sys.argv:
        one(*map(Path, sys.argv[-2:]))
        return
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--reach", type=float, default=1500.0)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--views", default=",".join(CAMERAS))
    given = parser.parse_args()
    print("| view | setting | build s | render s | MB | trees | ground | error |")
    print(f"|{8 * '---|'}")
    for view in given.views.split(","):
        reference = None
        for name, row in ROWS.items():
            place = given.work / view / name.replace(", ", "_").replace(" ", "_")
            found, picture = measure(place, row, CAMERAS[view], given)
            reference = picture if reference is None else reference
            numbers = f"{found['build']:.1f} | {found['render']:.1f} | {found['MB']:.0f}"
            numbers += f" | {found['trees']:,} | {found['ground']:,}"
            print(f"| {view} | {name} | {numbers} | {error(reference, picture):.4f} |", flush=True)


if __name__ == "__main__":
    main()
