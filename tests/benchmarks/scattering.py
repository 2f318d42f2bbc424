"""Light inside smoke, solved once per frame, against 32 bounces; FLIP and time.

The smoke is a plume in the wind, solved, painted and lit as in a shot, and rendered by Cycles in a separate
process. Pictures are compared by the mean FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for
Alternating Images"). A row gives the FLIP between two noise seeds: smaller differences do not show. The
reference scatters forwards, as smoke does, and attenuates light by all of the smoke.
"""

from __future__ import annotations

import os
import sys
import tempfile
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from firetwin.bench.harness import OURS, Bench
from firetwin.bench.timing import Stopwatch, Times
from firetwin.jobs import worker
from firetwin.progress import MessageCallback, Progress, no_message, silent
from firetwin.run import sun
from firetwin.shot import sections, settings
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.shot import Shot
from firetwin_core import flow, volume
from numpy.typing import NDArray

if TYPE_CHECKING:
    import bpy

MOMENT = datetime(2014, 9, 17, 23, 12, tzinfo=UTC)
PLACE = 38.97, -120.56
VIEW = CameraKey(0.0, PLACE[0] - 0.036, PLACE[1] - 0.01, 900.0, "point", *PLACE, 700.0)
LENS = 60.0  # mm; the plume fills half of the picture
RESOLUTION, SAMPLES = (160, 90), 16
SPACING, SHAPE, LEVELS, DEPTH, VOXEL = 80.0, (40, 64), 36, 60.0, 40.0  # m, rows and columns, levels; m
MODEL_TIMES = 25  # of the sample; arrival times are complete
WIND, POWER, SMOKE = 6.0, 6e9, 1.2e-9  # m/s, W, kg/J
REFERENCE, OTHER_GRAIN = "32 bounces", "firetwin, other noise seed"
WAYS = {OURS: ("solved", 1), REFERENCE: ("traced", 32), OTHER_GRAIN: ("solved", 1)}  # lighting, bounces
LIMIT = 0.15  # FLIP, of a picture half of which is smoke


def run(bench: Bench) -> None:
    """Render every variant, then compare."""
    flip = bench.flip()
    if flip is None:
        return
    with tempfile.TemporaryDirectory() as folder:
        seconds = worker.run(partial(render_in_blender, folder))
        errors = {
            name: flip.evaluate(
                picture(folder, OURS if name == OTHER_GRAIN else REFERENCE), picture(folder, name), "LDR"
            )[1]
            for name in seconds
        }
    for name, each in seconds.items():
        bench.row(
            f"smoke in {RESOLUTION[0]} by {RESOLUTION[1]} pixels",
            name,
            Times((each,)),
            RESOLUTION[0] * RESOLUTION[1],
            "pixel",
            error=None if name == REFERENCE else errors[name],
            error_unit="FLIP",
            threads=os.cpu_count() or 1,
        )
    bench.target(
        "Image difference against 32 bounces, light in smoke", errors[OURS], LIMIT, "FLIP", most=True
    )


def picture(folder: str, name: str) -> str:
    """Return the path of the picture called `name`."""
    return str(Path(folder) / f"{name.replace(' ', '_').replace(',', '')}.png")


def plume() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Solve five minutes of a steady fire's smoke; return extinction (nx, ny, nz), 1/m, and freshness."""
    levels = np.arange(LEVELS + 1) * DEPTH
    theta = [300.0, 300.0 + 0.004 * levels[-1]]
    profile = flow.Profile([0.0, levels[-1]], theta, [[WIND, 0.0], [2 * WIND, 0.0]])
    solver = flow.Solver(flow.Domain(levels, SHAPE, SPACING), profile)
    place = np.array([0.25 * SHAPE[1], 0.5 * SHAPE[0]]) * SPACING
    place = place + np.random.default_rng(1).uniform(-200.0, 200.0, (40, 2))
    solver.set_sources(place, np.full(40, POWER / 40), np.full(40, SMOKE * POWER / 40))
    solver.step(5.0, 60)
    middle = 0.5 * (levels[1:] + levels[:-1])
    detail = flow.Detail(
        smoke=solver.smoke(),
        age=solver.age(),
        rise=solver.velocity()[..., 2],
        temperature_excess=solver.temperature_excess(),
        drift=np.zeros((*solver.shape, 2, 3), np.float32),
        weights=(1.0, 0.0),
        turns=(0, 0),
        spacing=SPACING,
        corner=(0.0, 0.0),
        levels=middle,
        heights=np.broadcast_to(middle[:, None, None], solver.shape),
        ground=np.zeros(SHAPE),
    )
    columns, rows, layers = (
        int(side / VOXEL) for side in (SHAPE[1] * SPACING, SHAPE[0] * SPACING, levels[-1])
    )
    flat = np.zeros((columns, rows))
    density, fresh, _ = detail.paint((0.0, 0.0, 0.0), VOXEL, flat, flat + 1.0, layers)
    return density, fresh


def scene_file(folder: Path) -> settings.Settings:
    """Describe one frame of the sample from a drone."""
    return settings.Settings(
        path=folder / "scene.toml",
        run=folder / "sample",
        cache=folder / "cache",
        time=sections.Time(start=MOMENT, frames=1),
        smoke=sections.SmokeSettings(method="flow", voxel_size=VOXEL),
        light=sections.Light(exposure=0.5),
        cameras=(settings.Camera(rig=Drone(keys=(VIEW,), focal_length=LENS)),),
        render=settings.Render(resolution=RESOLUTION, samples=SAMPLES, passes=("rgb",)),
    )


# The following functions run in the worker process, where Blender is.


def render_in_blender(
    folder: str, progress: Progress = silent, tell: MessageCallback = no_message
) -> dict[str, float]:
    """Render the picture in every variant; return the time (s) of each."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    looks = _build(scene_file(Path(folder)), scene)
    scene.cycles.samples, draft = 1, scene.cycles.samples
    bpy.ops.render.render()  # loads what later ones find loaded
    scene.cycles.samples = draft
    seconds = {}
    for done, (name, (lighting, bounces)) in enumerate(WAYS.items()):
        progress(done, len(WAYS))
        for smoke in bpy.data.volumes:
            smoke.materials[0] = looks[lighting]
        scene.cycles.volume_bounces = bounces
        scene.cycles.max_bounces = max(scene.cycles.max_bounces, bounces)
        scene.cycles.seed = int(name == OTHER_GRAIN)
        scene.render.filepath = picture(folder, name)
        watch = Stopwatch()
        bpy.ops.render.render(write_still=True)
        seconds[name] = watch.read().seconds
    return seconds


def _build(file: settings.Settings, scene: bpy.types.Scene) -> dict[str, bpy.types.Material]:
    """Build sun, camera and the plume where the camera looks; the smoke's material for each lighting."""
    from firetwin.blender import owned
    from firetwin.data import sample
    from firetwin.render import engine
    from firetwin.run import opening as runs
    from firetwin.scene import clock
    from firetwin.scene.camera import build as camera
    from firetwin.scene.light import build as light
    from firetwin.scene.smoke import build as smoke
    from firetwin.scene.smoke import flow_material
    from firetwin.smoke import bake, flow_frames
    from firetwin.smoke.flow import Flow

    sample.write(file.run, MODEL_TIMES, "npy")
    shot = Shot(file, runs.open(file.run))
    density, fresh = plume()
    middle = shot.paths[0].target[0]
    origin = (
        middle[0] - 0.4 * SHAPE[1] * SPACING,
        middle[1] - 0.5 * SHAPE[0] * SPACING,
        middle[2] - VIEW.target_height,
    )
    place = bake.folder(shot)
    place.mkdir(parents=True)
    for layer in flow_frames.layers(shot, Flow(shot)):
        part = 1.0 if layer.name == "smoke" else 0.0
        toward = sun.toward_light(shot.run, shot.frames.first)
        sunlight, skylight, _ = volume.smoke_light(part * density, VOXEL, toward, *flow_frames.LIGHT)
        grids = {"density": part * density, "fresh": fresh, "sun": sunlight, "sky": skylight}
        volume.write(str(layer.file(place, 1)), grids, VOXEL, origin, tolerance=1e-6, within="density")
    stage = owned.adopt(scene)
    clock.build(shot, stage)
    smoke.build(shot, stage)
    light.build(shot, stage)
    camera.build(shot, stage)
    engine.apply(file, scene)
    sys.path.append(str(Path(__file__).parents[1] / "helpers"))
    import traced_smoke

    return {"solved": flow_material.build(shot, stage), "traced": traced_smoke.build(shot, stage)}
