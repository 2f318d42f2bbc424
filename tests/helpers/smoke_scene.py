"""A small scene with puffs of smoke, built as `firetwin build` does, without a worker process."""

import pytest
from firetwin.jobs import build, worker
from firetwin.shot.source import ShotSource
from scene_text import DRONE, NO_PLANTS, PUFFS, THREE_FRAMES, TINY


def here(work, progress, stop=None, tell=lambda text: None, **_):
    """Replacement of a worker process: `jobs.worker.run` in this one."""
    return work(progress=progress, tell=tell)


def write(folder, run):
    """Write `folder`/scene.toml about a run, and scene.blend without volumes; return the messages."""
    puffs = PUFFS.format(smoke="true") + "max_age = 1800.0\n"
    parts = THREE_FRAMES.format(run=run), puffs, NO_PLANTS, TINY, DRONE.format()
    (folder / "scene.toml").write_text("".join(parts))
    said = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(worker, "run", here)
        build.run(ShotSource(scene=str(folder / "scene.toml")), folder / "scene.blend", tell=said.append)
    return said
