"""A small built scene with its live scene, as a file that tests of the live scene share."""

from dataclasses import replace

import bpy
import pytest
from firetwin.blender import owned
from firetwin.scene import build
from firetwin.scene.live import build as live
from firetwin.shot.shot import Shot
from made_once import made_once
from small_scene import simplify_looks, small_settings

BUDGET = 16_000
__all__ = ["live_blend", "live_stage"]


def _shot(run_folder, run, folder):
    """The small shot with some trees."""
    settings = small_settings(run_folder, folder)
    forest = replace(settings.forest, density="stand", budget=600, draw_distance=3000.0)
    return Shot(replace(settings, forest=forest), run)


@pytest.fixture(scope="session")
def live_blend(factory, run_folder, run, tmp_path_factory):
    """The small shot with a live scene of at most `BUDGET` triangles; 3D views show the film's scene."""

    def make(folder):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        stage = owned.adopt(bpy.context.scene)
        shot = _shot(run_folder, run, folder)
        with pytest.MonkeyPatch.context() as patch:
            simplify_looks(patch)
            build.build(shot, stage.scene)
        live.build(shot, stage.scene, BUDGET)
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / "live.blend"))

    return made_once(tmp_path_factory, "live", make) / "live.blend"


@pytest.fixture
def live_stage(scene, live_blend):
    """Our part of that file's scene."""
    bpy.ops.wm.open_mainfile(filepath=str(live_blend))
    return owned.stage(bpy.context.scene)
