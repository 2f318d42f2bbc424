"""A saved scene shows the same where Blender runs no scripts that come with files, as on farms."""

import shutil
from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.run import opening as runs
from firetwin.scene import build
from firetwin.scene.forest import levels, models, preview
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import forest


def test_scrubbing_a_saved_scene_moves_its_clock_and_camera(built_file):
    bpy.ops.wm.open_mainfile(filepath=str(built_file), use_scripts=False)
    seen = []
    for frame in (1, 3):
        bpy.context.scene.frame_set(frame)
        camera = bpy.context.scene.camera.matrix_world.translation.copy()
        seen.append((bpy.context.scene[nodes.TIME], camera))
    assert seen[1][0] - seen[0][0] == 3600.0
    assert (seen[1][1] - seen[0][1]).length > 500.0


@pytest.mark.posix("removal of files that are open")
def test_the_papers_trees_are_there_without_the_run(
    settings, run_folder, scene, plain_looks, tmp_path, monkeypatch
):
    """The file of a deleted run has as many trees of each class as the core plants."""
    monkeypatch.setattr(preview, "MOST", 10**9)  # the viewport, which is checked, shows all trees
    folder = tmp_path / "run"
    shutil.copytree(run_folder, folder)
    above = Satellite(swath=14_000.0, keys=settings.cameras[0].rig.keys)
    settings = replace(
        settings,
        run=folder,
        cameras=(Camera("above", above),),
        render=replace(settings.render, resolution=(4000, 4000)),
    )
    shot = Shot(settings, runs.open(folder))
    axes = shot.run.fuel_latitude, shot.run.fuel_longitude
    height, fuel = shot.run.fuel_elevation, shot.run.canopy_fuel
    wanted = forest.trees(fuel, *axes, height, shot.local_frame, seed=settings.seed)
    build.build(shot, scene)
    path = str(tmp_path / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    shutil.rmtree(folder)
    bpy.ops.wm.open_mainfile(filepath=path, use_scripts=False)
    points = bpy.data.objects["Firetwin Trees"].data
    model = np.empty(len(points.vertices), np.int32)
    points.attributes["model"].data.foreach_get("value", model)
    number = model // levels.LEVELS
    first = np.array([models.FIRST_MODEL[k] for k in range(3)])[wanted.size_class]
    assert np.array_equal(np.bincount(number), np.bincount(first + wanted.model))
    graph = bpy.context.evaluated_depsgraph_get()
    drawn = sum(
        item.is_instance and item.parent.original.name == "Firetwin Trees" for item in graph.object_instances
    )
    assert drawn == len(wanted.cell) > 1000
