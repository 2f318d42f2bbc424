"""Culling of a shot, cost against error: a drone's scene built and rendered culled and unculled.

Each scene is built and rendered in a separate process, without smoke, with the same trees in reach. Times are
CPU times. Memory is the peak of the process minus the memory of a started Blender. The error is the mean FLIP
(Andersson et al. 2020) against the unculled picture; a row gives the FLIP between two noise seeds.
"""

from __future__ import annotations

import os
import tempfile
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from .. import memory
from ..data import sample
from ..jobs import worker
from ..progress import MessageCallback, Progress, no_message, silent
from ..shot import sections, settings
from ..shot.cameras.rigs.drone import CameraKey, Drone
from .harness import OURS, Bench
from .timing import Stopwatch, Times

MOMENT = datetime(2014, 9, 17, 23, 12, tzinfo=UTC)
VIEW = CameraKey(0.0, 38.977, -120.572, 150.0, "head")
RESOLUTION, SAMPLES, CLEAN = (160, 90), 4, 128  # settings for timing, and for comparison, with little noise
REACH = 500.0  # m, draw distance of trees; larger ones take over a minute
MODEL_TIMES = 3  # of the sample; arrival times cover all
ALL, GRAIN = "unculled", "unculled, other noise seed"
TIMES, LESS, ERROR = 3.0, 3.0, 0.02  # targets: speed-up, memory ratio, FLIP at most


def run(bench: Bench) -> None:
    """Build and render both, then compare."""
    flip = bench.flip()
    if flip is None:
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sample.write(folder / "run", MODEL_TIMES, "npy")
        results = {tool: worker.run(partial(draw, name, tool == OURS, tool)) for tool in (OURS, ALL)}
        error = {
            tool: flip.evaluate(picture(name, ALL), picture(name, tool), "LDR")[1] for tool in (OURS, GRAIN)
        }
    size = f"{RESOLUTION[0]} x {RESOLUTION[1]} pixels"
    for step in ("build", "render"):
        for tool, each in results.items():
            bench.row(
                f"{size}: {step}",
                tool,
                Times((each[step],)),
                RESOLUTION[0] * RESOLUTION[1],
                "pixel",
                error=error.get(tool) if step == "render" else None,
                error_unit="FLIP",
                threads=os.cpu_count() or 1,
            )
    ours, unculled = results[OURS], results[ALL]
    seconds = [each["build"] + each["render"] for each in (unculled, ours)]
    bench.target("Build and render time, unculled / culled", seconds[0] / seconds[1], TIMES, "x")
    if ours["bytes"]:  # known
        bench.target("Memory, unculled / culled", unculled["bytes"] / ours["bytes"], LESS, "x")
    bench.row(f"{size}: render", GRAIN, None, 1, "pixel", error=error[GRAIN], error_unit="FLIP")
    bench.target("Image difference, culled against unculled", error[OURS], ERROR, "FLIP", most=True)


def picture(folder: str, tool: str) -> str:
    """Return the path of a tool's picture."""
    return str(Path(folder) / f"{tool.replace(' ', '_').replace(',', '')}.png")


def scene_file(folder: Path, cull: bool) -> settings.Settings:
    """Describe one frame of the sample from a drone, with or without culling."""
    return settings.Settings(
        path=folder / "scene.toml",
        run=folder / "run",
        cache=folder / "cache",
        time=sections.Time(start=MOMENT, frames=1),
        forest=sections.Forest(draw_distance=REACH),
        smoke=sections.SmokeSettings(enabled=False),
        cameras=(settings.Camera("drone", Drone(keys=(VIEW,))),),
        render=settings.Render(resolution=RESOLUTION, samples=SAMPLES, passes=("rgb",), cull=cull),
    )


# The following functions run in the worker process, where Blender is.


def draw(
    folder: str, cull: bool, tool: str, progress: Progress = silent, tell: MessageCallback = no_message
) -> dict[str, float]:
    """Build and render a scene, with two seeds if unculled; return CPU seconds of both, and bytes."""
    import bpy

    from ..jobs import worker_scene
    from ..run import opening as runs
    from ..shot.shot import Shot

    file = scene_file(Path(folder), cull)
    before, watch = memory.peak(), Stopwatch()
    stage = worker_scene.build_scene(Shot(file, runs.open(file.run)), progress, tell)
    built = watch.read().processor
    stage.scene.camera = stage.camera("drone")
    stage.scene.frame_set(1)
    bpy.ops.render.render(scene=stage.scene.name)
    results = {
        "build": built,
        "render": watch.read().processor - built,
        "bytes": memory.peak() - before,
    }
    stage.scene.cycles.samples = CLEAN
    for seed, name in ((0, tool), (1, GRAIN))[: 1 if cull else 2]:
        stage.scene.cycles.seed = seed
        stage.scene.render.filepath = picture(folder, name)
        bpy.ops.render.render(write_still=True, scene=stage.scene.name)
    return results
