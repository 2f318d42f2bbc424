"""Costs of film and live scene in 3D views, counted without a graphics card."""

import bpy
from firetwin.blender import owned
from firetwin.scene.live import cost, switch
from live_scene import *  # noqa: F403
from live_scene import BUDGET


def test_counts_equal_those_by_hand(stage):
    """Three instances of a square with a picture of 8 x 4 floats and one of 4 x 4 bytes, and a lone one."""
    square = bpy.data.meshes.new("square")
    square.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    look = bpy.data.materials.new("look")
    look.use_nodes = True
    for width, floats in ((8, True), (4, False)):
        node = look.node_tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new(f"picture {width}", width, 4, float_buffer=floats)
        node.image.use_half_precision = True
    square.materials.append(look)
    inner = bpy.data.collections.new("inner")
    inner.objects.link(bpy.data.objects.new("inner", square))
    for k in range(3):
        empty = bpy.data.objects.new(f"empty {k}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
        stage.scene.collection.objects.link(empty)
    owned.add(stage.root, "Square", square)
    found = cost.measure(stage.scene)
    assert (found.triangles, found.instances, found.batches) == (8, 3, 1)
    assert found.texture_bytes == 8 * 4 * 4 * 2 + 4 * 4 * 4
    assert found.volume_bytes == 0
    assert found.text().startswith("0.00 million triangles, 3 instances, 1 batches")


def test_measuring_changes_nothing(live_stage):
    scene = live_stage.scene
    nodes = {each.name: len(each.node_tree.nodes) for each in bpy.data.materials if each.node_tree}
    film, live = cost.measure(scene, False), cost.measure(scene, True)
    assert {each.name: len(each.node_tree.nodes) for each in bpy.data.materials if each.node_tree} == nodes
    assert not switch.is_live(scene)
    assert cost.measure(scene) == film
    assert film.instances > 0
    assert live.instances == 0
    assert 0 < live.triangles <= BUDGET
    assert live.texture_bytes > 0
