"""Steps along rays through smoke: how far the picture is from one drawn with a quarter of the step, and time.

The smoke is that of a moment of the sample run, before the sky, drawn by Cycles in a process of its own with
the same grain at every step. Error is the mean FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator
for Alternating Images"). Beside it stands what another grain at one and the same step makes: less than that
does not show. Times are of whole renders, in the full benchmark.
"""

from __future__ import annotations

import os
import tempfile
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..jobs import worker
from ..progress import Progress, Tell, silent, untold
from ..shot.cameras.rigs.drone import CameraKey, Drone
from ..shot.settings import settings
from ..shot.shot import Shot
from .harness import OURS, Bench
from .timing import LEAST, Times

if TYPE_CHECKING:
    import bpy

MOMENT = datetime(2014, 9, 17, 23, 12, tzinfo=UTC)
VIEW = CameraKey(0.0, 38.990, -120.5505, 600.0, "head")  # 2 km off the head of the fire
MODEL_TIMES = 25  # of the sample; the smoke comes from the fuel's arrival times, which are all there
RESOLUTION, SAMPLES = (160, 90), 8
FINEST, OTHER_GRAIN = "a quarter of the step", "our step, other grain"
STEPS = {
    OURS: 1.0,
    "4 times the step": 4.0,
    "twice the step": 2.0,
    "half the step": 0.5,
    FINEST: 0.25,
    OTHER_GRAIN: 1.0,
}
LIMIT = 0.05  # FLIP, as between pictures by several versions of Blender


def run(bench: Bench) -> None:
    """Render every step, then compare."""
    flip = bench.flip()
    if flip is None:
        return
    with tempfile.TemporaryDirectory() as folder:
        found = worker.run(
            f"{__name__}:render_in_blender", {"folder": folder, "times": LEAST if bench.full else 1}
        )
        errors = {
            name: flip.evaluate(picture(folder, reference(name)), picture(folder, name), "LDR")[1]
            for name in found
        }
    taken = {name: Times(tuple(seconds)) if bench.full else None for name, seconds in found.items()}
    rows(bench, RESOLUTION, taken, errors, FINEST)
    bench.target(
        "a picture of smoke off that with a quarter of the step by", errors[OURS], LIMIT, "FLIP", most=True
    )


def rows(
    bench: Bench,
    size: tuple[int, int],
    taken: dict[str, Times | None],
    errors: dict[str, float],
    exact: str,
) -> None:
    """A row for each way to render smoke in so many pixels: times, and FLIP beside the `exact` one."""
    for name, times in taken.items():
        bench.row(
            f"smoke in {size[0]} by {size[1]} pixels",
            name,
            times,
            size[0] * size[1],
            "pixel",
            error=None if name == exact else errors[name],
            error_unit="FLIP",
            threads=os.cpu_count() or 1,
        )


def reference(name: str) -> str:
    """Which picture another is compared with."""
    return OURS if name == OTHER_GRAIN else FINEST


def picture(folder: str, name: str) -> str:
    """Where the picture called `name` is written."""
    return str(Path(folder) / f"{name.replace(' ', '_').replace(',', '')}.png")


def scene_file(folder: Path) -> settings.Settings:
    """One frame of the sample's smoke from a drone."""
    return settings.Settings(
        path=folder / "scene.toml",
        run=folder / "sample",
        cache=folder / "cache",
        time=settings.Time(start=MOMENT, frames=1),
        smoke=settings.Smoke(method="puffs"),
        cameras=(settings.Camera(rig=Drone(keys=(VIEW,))),),
        render=settings.Render(resolution=RESOLUTION, samples=SAMPLES, denoise=False, passes=("rgb",)),
    )


# What follows runs in the worker process, where Blender is.


def render_in_blender(
    folder: str, times: int, progress: Progress = silent, tell: Tell = untold
) -> dict[str, list[float]]:
    """Draw the pictures, all in turn, `times` over; the times (s) of each."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    smoke = _build(scene_file(Path(folder)), scene)
    step = smoke.data.render.step_size
    bpy.ops.render.render()  # loads what later ones find loaded
    seconds = {name: [] for name in STEPS}
    for done in range(times):
        progress(done, times)
        for name, factor in STEPS.items():
            smoke.data.render.step_size = factor * step
            scene.cycles.seed = int(name == OTHER_GRAIN)
            scene.render.filepath = picture(folder, name)
            seconds[name].append(_draw())
    return seconds


def _build(file: settings.Settings, scene: bpy.types.Scene) -> Any:
    """Build smoke, sun and camera, and return the smoke."""
    from firetwin_core import run as runs

    from ..blender import owned
    from ..data import sample
    from ..render import engine
    from ..scene import clock
    from ..scene.camera import build as camera
    from ..scene.light import build as light
    from ..scene.smoke import build as smoke
    from ..smoke import bake

    sample.write(file.run, MODEL_TIMES, "npy")
    shot = Shot(file, runs.open(file.run))
    bake.bake(shot)
    stage = owned.adopt(scene)
    clock.build(shot, stage)
    made = smoke.build(shot, stage)
    light.build(shot, stage)
    camera.build(shot, stage)
    engine.apply(file, scene)
    return made


def _draw() -> float:
    """Seconds of a render that writes its picture."""
    import time

    import bpy

    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    return time.perf_counter() - start
