"""The noise of the ground's material, worked out in NumPy."""

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.scene.forest import shader_noise


@pytest.mark.parametrize(("size", "octaves", "roughness"), [(820.0, 3, 0.45), (62.0, 4, 0.68), (5.0, 0, 0.5)])
def test_it_is_blenders_own(scene, size, octaves, roughness):
    place = np.random.default_rng(4).uniform(-3000.0, 3000.0, (4000, 3)).astype(np.float32)
    data = bpy.data.meshes.new("places")
    data.vertices.add(len(place))
    data.vertices.foreach_set("co", place.ravel())
    thing = bpy.data.objects.new("places", data)
    scene.collection.objects.link(thing)
    tree, given = nodes.geometry("noise")
    inputs = {"Scale": 1.0 / size, "Detail": octaves, "Roughness": roughness}
    value = tree.output("ShaderNodeTexNoise", {"Vector": tree.output("GeometryNodeInputPosition"), **inputs})
    stored = tree.output(
        "GeometryNodeStoreNamedAttribute",
        {"Geometry": tree.pick(given, "Geometry"), "Name": "found", "Value": value},
        data_type="FLOAT",
        domain="POINT",
    )
    tree.geometry(stored)
    thing.modifiers.new("noise", "NODES").node_group = tree.node_tree
    made = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    wanted = np.empty(len(place), np.float32)
    made.attributes["found"].data.foreach_get("value", wanted)
    found = shader_noise.fractal(place.astype(np.float64), size, octaves, roughness)
    assert np.abs(found - wanted).max() < 2e-3
    assert wanted.std() > 0.05
