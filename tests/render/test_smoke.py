"""Smoke in the scene: baked once, read by Blender, seen in the picture."""

from dataclasses import replace

import bpy
import levels_run
import numpy as np
import pytest
from firetwin.render import layers
from firetwin.run import opening as runs
from firetwin.scene import build
from firetwin.shot.sections import SmokeSettings
from firetwin.shot.shot import Shot
from firetwin.smoke import bake


@pytest.fixture
def run(run_folder, tmp_path):
    """The small run, with smoke on levels, which Cycles draws."""
    return runs.open(levels_run.write(run_folder, tmp_path / "run"))


@pytest.fixture
def smoky(settings):
    return replace(settings, smoke=SmokeSettings(voxel_size=120.0))


@pytest.fixture
def shot(smoky, run):
    return Shot(smoky, run)


def test_no_picture_changes_without_what_it_does_not_see(smoky, run, stage, scene, shoot, tmp_path):
    """Left out smoke changes the picture by less than the grain of other seeds does."""
    camera = smoky.cameras[0]
    far = replace(camera, rig=replace(camera.rig, focal_length=200.0))
    close = replace(smoky, cameras=(far,), cache=tmp_path / "close")
    whole = replace(close, smoke=replace(close.smoke, complete=True), cache=tmp_path / "whole")
    pictures, sizes = [], []
    for settings in (whole, close):
        shot = Shot(settings, run)
        place = bake.bake(shot, frames=[3])
        sizes.append((place / "smoke_000003.vdb").stat().st_size)
        build.build(shot, scene)
        layers.build(settings, stage)
        scene.frame_set(3)
        pictures.append(shoot(scene, "rgb"))
    scene.cycles.seed += 1
    grain = np.abs(shoot(scene, "rgb") - pictures[1]).mean()
    change = np.abs(pictures[1] - pictures[0]).mean()
    print(f"bytes {sizes}, change {change:.2e}, grain {grain:.2e}")
    assert sizes[1] < 0.8 * sizes[0]
    assert change < 0.2 * grain


def test_smoke_changes_the_picture(shot, stage, scene, shoot):
    bake.bake(shot, frames=[3])
    build.build(shot, scene)
    layers.build(shot.settings, stage)
    scene.frame_set(3)
    shown = shoot(scene, "rgb")
    bpy.data.objects["Firetwin Smoke"].hide_render = True
    assert np.mean(np.abs(shown - shoot(scene, "rgb"))) > 0.02
