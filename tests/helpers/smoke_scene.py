"""A small scene with the smoke of its run, built as `firetwin build` does, without a worker process."""

import levels_run
import pytest
from firetwin.jobs import build, worker
from firetwin.shot.source import ShotSource
from scene_text import DRONE, NO_PLANTS, THREE_FRAMES, TINY


def here(work, progress, stop=None, tell=lambda text: None, **_):
    """Replacement of a worker process: `jobs.worker.run` in this one."""
    return work(progress=progress, tell=tell)


def write(folder, run):
    """Write `folder`/scene.toml about a run, and scene.blend without volumes; return the messages."""
    levels = levels_run.write(run, folder / "levels")
    parts = THREE_FRAMES.format(run=levels), "[smoke]\nvoxel_size = 120.0\n", NO_PLANTS, TINY, DRONE.format()
    (folder / "scene.toml").write_text("".join(parts))
    said = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(worker, "run", here)
        build.run(ShotSource(scene=str(folder / "scene.toml")), folder / "scene.blend", tell=said.append)
    return said
