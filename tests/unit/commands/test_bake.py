"""Smoke is baked in a separate process, which needs no Blender."""

import os
from pathlib import Path

import pytest
from firetwin.errors import Error
from firetwin.jobs import bake, worker
from firetwin.progress import no_message, silent
from firetwin.shot.source import ShotSource
from scene_text import DRONE, NO_PLANTS, TINY

SMOKY = """\
run = '{run}'
[time]
frames = 2
shutter = 0.0
[smoke]
method = "preview"
spin_up = 60.0
draw = "volume"
voxel_size = 400.0
"""


@pytest.fixture
def here(monkeypatch):
    """Bake in this process."""
    monkeypatch.setattr(worker, "run", lambda work, *_, **__: work(progress=silent, tell=no_message))


@pytest.fixture
def choice(tmp_path, make_run):
    scene = tmp_path / "scene.toml"
    scene.write_text(SMOKY.format(run=make_run()) + NO_PLANTS + TINY + DRONE.format())
    return ShotSource(scene=str(scene))


def test_baking_needs_no_blender(tmp_path, choice, monkeypatch):
    (tmp_path / "without").mkdir()
    (tmp_path / "without/bpy.py").write_text("raise ImportError('Blender was imported')")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path / 'without'}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    (folder,) = bake.run(choice)
    assert any(folder.glob("**/*.vdb"))


def test_volumes_are_written_for_the_chosen_frames_and_all_cameras(choice, here):
    """A .blend file has all cameras; `render` uses the volumes of each camera alone."""
    scene = Path(choice.scene)
    scene.write_text(
        scene.read_text() + DRONE.replace("drone", "other").replace("-120.56", "-120.57").format()
    )
    assert len(bake.run(choice)) == 2
    (folder,) = bake.run(choice, volumes=True, frames=[2, 7])
    assert sorted(path.name for path in folder.iterdir()) == [
        "far_000002.vdb",
        "smoke_000002.txt",
        "smoke_000002.vdb",
    ]


def test_smoke_that_is_integrated_along_rays_needs_no_volumes(choice, here):
    """Only the flow is solved, as a farm's stage bake does."""
    scene = Path(choice.scene)
    scene.write_text(scene.read_text().replace('draw = "volume"', "cell_budget = 0.1"))
    (*folders,) = bake.run(choice)
    assert folders
    assert sorted(path.name for path in folders[0].glob("moment*")) == [
        "moment_000001.npz",
        "moment_000002.npz",
    ]
    assert not [*Path(folders[0]).parent.rglob("*.vdb")]


def test_a_bake_that_is_ended_says_how_and_what_may_help(choice, monkeypatch):
    def ended(*_, **__):
        raise worker.EndedError("stopped on signal 9 (SIGKILL)")

    monkeypatch.setattr(worker, "run", ended)
    with pytest.raises(Error, match=r"the bake stopped on signal 9 .*larger voxels"):
        bake.run(choice)
