"""Smoke is baked in a separate process, which needs no Blender."""

import os

import pytest
from firetwin.errors import Error
from firetwin.jobs import bake, worker
from firetwin.shot.source import ShotSource
from scene_text import DRONE, NO_PLANTS, TINY

SMOKY = """\
run = "{run}"
[time]
frames = 2
[smoke]
method = "puffs"
voxel_size = 400.0
"""


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


def test_a_bake_that_is_ended_says_how_and_what_may_help(choice, monkeypatch):
    def ended(*_, **__):
        raise worker.EndedError("stopped on signal 9 (SIGKILL)")

    monkeypatch.setattr(worker, "run", ended)
    with pytest.raises(Error, match=r"the bake stopped on signal 9 .*larger voxels"):
        bake.run(choice)
