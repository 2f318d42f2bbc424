"""The live scene of a saved file plays in Blender alone, and its pictures are those with the add-on."""

import subprocess
import sys
from pathlib import Path

import bare_frames
import bpy
import numpy as np
import pytest
from firetwin.jobs import build as build_job
from firetwin.jobs import worker
from firetwin.scene.live import build as live_build
from firetwin.scene.live import smoke, smoke_grid
from firetwin.shot.source import ShotSource
from made_once import made_once
from panel_scene import SCENE
from smoke_scene import here


def _text(run):
    """Scene file of the small shot with some trees."""
    forest = 'density = "stand"\nbudget = 600\ndraw_distance = 3000.0\n'
    return SCENE.format(run=run).replace('density = "paper"\n', forest).replace("trees = false\n", "")


def _smoke(shot, stage, *_):
    """Smoke above the fire that becomes thicker, in place of a solved flow."""
    heights = shot.run.elevation.max() + np.linspace(-400.0, 1200.0, 17)
    across = np.linspace(-3000.0, 3000.0, 17)
    grid = smoke_grid.SmokeGrid((across, across, heights), (across, across, heights))
    opacity = np.zeros((16, 16, 16), np.float32)
    opacity[4:12, 4:12, 4:12] = 0.1
    light = np.full((16, 16, 16, 3), 0.5, np.float32)
    pair = [smoke_grid.Slabs(light, opacity * factor) for factor in (0.2, 2.0)]
    first, last = shot.frames.first, shot.frames.last
    low = np.array([-3000.0, -3000.0])
    shadow = np.stack([np.ones((4, 4)), np.full((4, 4), 0.5)]).astype(np.float32)
    return smoke.Smoke(grid, np.array([first, last]), [pair] * 3, shadow, low, -low)


@pytest.fixture(scope="module")
def pictures(factory, run_folder, tmp_path_factory):
    """Pictures without and with the add-on, each from a separate process."""

    def make(folder):
        (folder / "scene.toml").write_text(_text(run_folder))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(live_build, "TRIANGLES", 20_000)
            patch.setattr(smoke, "bake", _smoke)
            patch.setattr(worker, "run", here)
            build_job.run(ShotSource(scene=str(folder / "scene.toml")), folder / "scene.blend", live=True)
        for name, options in (("bare", []), ("addon", ["--addon"])):
            script = str(Path(bare_frames.__file__))
            line = [sys.executable, script, folder / "scene.blend", folder / f"{name}.npz", *options]
            done = subprocess.run([*map(str, line)], capture_output=True, text=True, timeout=300)
            assert done.returncode == 0, done.stdout + done.stderr

    folder = made_once(tmp_path_factory, "live_plays", make)
    return [np.load(folder / f"{name}.npz") for name in ("bare", "addon")]


def test_pictures_without_the_addon_are_those_with_it(pictures):
    bare, with_addon = pictures
    assert {*bare} == {"film", "nothing", *bare_frames.PARTS}
    for name in bare:
        np.testing.assert_array_equal(bare[name], with_addon[name], name)
    assert np.ptp(bare["film"][0]) > 0.1


@pytest.mark.parametrize("name", bare_frames.PARTS)
def test_the_time_of_the_scene_alone_moves_each_part(pictures, name):
    """With still light and a still camera the sky does not change, and each part does."""
    still, moved = (pictures[0][each] for each in ("nothing", name))
    np.testing.assert_array_equal(still[0], still[1])
    assert np.abs(moved[0] - still[0]).max() > 0.01  # it is in the picture
    assert (np.abs(moved[1] - moved[0]).max(axis=-1) > 0.01).sum() >= 5


def test_nothing_is_registered_here():
    assert not hasattr(bpy.types.Scene, "firetwin")
