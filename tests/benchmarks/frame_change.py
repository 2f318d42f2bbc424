"""A frame change in Blender's viewport: the sample's ground, forest, fire and light at their full size.

CPU time of one view layer, as in a window, without smoke, which is read from files. Further rows hide one
object each; the difference is the cost of that object.
"""

from __future__ import annotations

import tempfile
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from firetwin.bench.harness import OURS, Bench
from firetwin.bench.timing import LEAST, Stopwatch, Times
from firetwin.jobs import worker
from firetwin.progress import MessageCallback, Progress, no_message, silent
from firetwin.shot import sections, settings
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.shot import Shot

START, END = datetime(2014, 9, 17, 23, 0, tzinfo=UTC), datetime(2014, 9, 17, 23, 24, tzinfo=UTC)
VIEW = CameraKey(0.0, 38.984, -120.558, 600.0, "head")
FRAMES = 48
MODEL_TIMES = 25  # of the sample; fire and forest depend on the arrival times, which are complete
LIMIT = 5.0  # ms


def run(bench: Bench) -> None:
    """Build the scene in a separate process, and change its frame there."""
    if not bench.blender():
        return
    with tempfile.TemporaryDirectory() as folder:
        found = worker.run(partial(change_in_blender, folder, 2 * LEAST))
    for case, seconds in found.items():
        bench.row("the sample's scene", case, Times(tuple(seconds)), 1, "frame")
    milliseconds = [1e3 * each for each in found[OURS]]
    bench.target("Time of a frame change in the viewport", milliseconds, LIMIT, "ms", most=True)


def scene_file(folder: Path) -> settings.Settings:
    """Describe the first half hour of the run up the canyon, from a drone, without smoke."""
    return settings.Settings(
        path=folder / "scene.toml",
        run=folder / "sample",
        cache=folder / "cache",
        time=sections.Time(start=START, end=END, frames=FRAMES),
        smoke=sections.SmokeSettings(enabled=False),
        cameras=(settings.Camera(rig=Drone(keys=(VIEW,))),),
    )


# The following functions run in the worker process, where Blender is.


def change_in_blender(
    folder: str, times: int, progress: Progress = silent, tell: MessageCallback = no_message
) -> dict[str, list[float]]:
    """Return the CPU seconds of each frame change, with all objects and without each animated one."""
    import bpy
    from firetwin.data import sample
    from firetwin.run import opening as runs
    from firetwin.scene import build

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene, file = bpy.context.scene, scene_file(Path(folder))
    sample.write(file.run, MODEL_TIMES, "npy")
    build.build(Shot(file, runs.open(file.run)), scene)
    changes = {OURS: _changes(times)}
    animated = [obj for obj in scene.objects if obj.modifiers and not obj.hide_viewport]
    for obj in animated:
        obj.hide_viewport = True
        changes[f"without {obj.name.removeprefix('Firetwin ')}"] = _changes(times)
        obj.hide_viewport = False
    return changes


def _changes(times: int) -> list[float]:
    """Return the CPU seconds of `times` frame changes spread over the shot, after one that is not counted."""
    import bpy

    scene, found = bpy.context.scene, []
    for number in range(times + 1):
        watch = Stopwatch()
        scene.frame_set(1 + 7 * number % FRAMES)
        found.append(watch.read().processor)
    return found[1:]
