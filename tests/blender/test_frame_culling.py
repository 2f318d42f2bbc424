from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import mesh
from firetwin.scene.forest import build as forest
from firetwin.scene.forest import stand
from firetwin.scene.forest.frame_culling import IN_VIEW, FrameCulling
from firetwin.shot.shot import Shot

pytestmark = pytest.mark.usefixtures("whole_forest")


def _in_view(trees):
    values = np.empty(len(trees.data.vertices), bool)
    trees.data.attributes[IN_VIEW].data.foreach_get("value", values)
    return values


def _instances(name):
    graph = bpy.context.evaluated_depsgraph_get()
    return sum(item.is_instance and item.parent.original.name == name for item in graph.object_instances)


def test_a_render_instances_the_trees_that_its_frame_shows(shot, stage):
    forest.build(shot, stage, stand.grow(shot))
    trees = bpy.data.objects["Firetwin Trees"]
    assert _in_view(trees).all()
    assert _instances(trees.name) == len(trees.data.vertices)
    culling, seen = FrameCulling(shot, stage), []
    for frame in range(1, shot.frames.count + 1):
        culling.apply(frame)
        seen.append(_in_view(trees))
        bpy.context.view_layer.update()
        assert _instances(trees.name) == seen[-1].sum()
    assert np.any(seen, axis=0).all()  # each tree was planted because a frame shows it


def test_without_culling_no_frame_hides_a_tree(settings, run, stage):
    shot = Shot(replace(settings, render=replace(settings.render, cull=False)), run)
    forest.build(shot, stage, stand.grow(shot))
    FrameCulling(shot, stage).apply(1)
    assert _in_view(bpy.data.objects["Firetwin Trees"]).all()


def test_a_view_without_trees_hides_none(shot, stage):
    forest.build(shot, stage, stand.grow(shot))
    trees = bpy.data.objects["Firetwin Trees"]
    trees.data.clear_geometry()  # as in a satellite's view: its trees belong to the ground's colour
    mesh.add_attribute(trees.data, IN_VIEW, "BOOLEAN", np.ones(0))
    FrameCulling(shot, stage).apply(1)
    assert not trees.data.vertices
