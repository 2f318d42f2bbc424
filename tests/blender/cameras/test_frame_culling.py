from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import mesh
from firetwin.scene.forest import build as forest
from firetwin.scene.forest import stand, visibility
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


def test_from_far_above_the_colour_of_the_ground_replaces_trees():
    far = np.column_stack([np.linspace(0.0, 30_000.0, 301), np.zeros((301, 2))])
    drawn = visibility.is_drawn(far, [np.zeros(3)], 12_000.0)
    assert drawn[far[:, 0] < 12_000.0].all()
    assert not drawn[far[:, 0] > 12_000.0 * visibility.TREES_END].any()
    between = (far[:, 0] > 12_500.0) & (far[:, 0] < 14_500.0)
    assert 0.2 < drawn[between].mean() < 0.8, "one by one"
    assert visibility.is_drawn(far, [], 12_000.0).all(), "a satellite resolves trees at any distance, or none"


def test_a_view_without_trees_hides_none(shot, stage):
    forest.build(shot, stage, stand.grow(shot))
    trees = bpy.data.objects["Firetwin Trees"]
    trees.data.clear_geometry()  # as in a satellite's view: its trees belong to the ground's colour
    mesh.add_attribute(trees.data, IN_VIEW, "BOOLEAN", np.ones(0))
    FrameCulling(shot, stage).apply(1)
    assert not trees.data.vertices
