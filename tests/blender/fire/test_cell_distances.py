"""Distances of flames and of opaque smoke that surfaces read for each ray."""

import bpy
import numpy as np
from firetwin.blender import nodes
from firetwin.scene import cell_distances

IMAGE = "Firetwin Cell Distances"


def test_surfaces_read_the_distances_of_flames_and_smoke_from_an_image(stage):
    tree = nodes.Tree(bpy.data.node_groups.new("probe", "ShaderNodeTree"))
    cell_distances.write(tree, stage, tree.emission((1.0, 1.0, 1.0)))
    image = bpy.data.images[IMAGE]
    flames, smoke = np.float32([[10.0, 20.0, 30.0], [40.0, 50.0, 60.0]]), np.full((2, 3), 70.0, np.float32)
    cell_distances.set_distances(stage, flames, smoke)
    assert tuple(image.size) == (3, 2)
    pixels = np.array(image.pixels[:]).reshape(2, 3, 4)
    assert pixels[..., 0].tolist() == flames[::-1].tolist(), "rows of images begin at the bottom"
    assert (pixels[..., 1] == np.float32(1.0 / 70.0)).all()
    cell_distances.set_distances(stage)
    assert np.array(image.pixels[:2]).tolist() == [0.0, 0.0], "as of an image that a saved scene lost"


def test_a_scene_without_such_surfaces_needs_no_image(stage):
    cell_distances.set_distances(stage, np.zeros((2, 2), np.float32))
    assert IMAGE not in bpy.data.images
