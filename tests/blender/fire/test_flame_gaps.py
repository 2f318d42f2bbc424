"""Distance of flames that surfaces read for each ray."""

import bpy
import numpy as np
from firetwin.blender import nodes
from firetwin.scene import flame_gaps


def test_surfaces_read_the_distance_of_flames_from_an_image(stage):
    flame_gaps.write(nodes.Tree(bpy.data.node_groups.new("probe", "ShaderNodeTree")), stage)
    image = bpy.data.images["Firetwin Flame Distance"]
    flame_gaps.set_distance(stage, np.float32([[10.0, 20.0, 30.0], [40.0, 50.0, 60.0]]))
    assert tuple(image.size) == (3, 2)
    red = np.array(image.pixels[:]).reshape(2, 3, 4)[..., 0]
    assert red.tolist() == [[40.0, 50.0, 60.0], [10.0, 20.0, 30.0]], "rows of images begin at the bottom"
    flame_gaps.set_distance(stage, None)
    assert not np.array(image.pixels[:]).any()


def test_a_scene_without_such_surfaces_needs_no_image(stage):
    flame_gaps.set_distance(stage, np.zeros((2, 2), np.float32))
    assert "Firetwin Flame Distance" not in bpy.data.images
