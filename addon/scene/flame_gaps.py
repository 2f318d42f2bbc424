"""Share of a pixel's rays that meet a surface before the flames, next to flames drawn as a field.

Foliage in front of flames has gaps that are smaller than pixels. The depth of the ray through a pixel's
centre shows a gap as a square of one pixel, or not at all. The integrated renderer therefore stores the
distance of the flames in each pixel in an image, and surfaces compare their own distance to it for every ray.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender import nodes, owned
from ..blender.owned import Stage

AOV = "Firetwin Before Flames"
_GROUP, _IMAGE = "flame gaps", "Flame Distance"


def write(tree: nodes.Tree, stage: Stage) -> None:
    """Write 1 to the AOV where the surface is nearer than the flames in its pixel, else 0."""
    before = tree.output("ShaderNodeGroup", (), "Before", node_tree=_shader_group(stage))
    tree.aov(AOV, before, colour=False)


def set_distance(stage: Stage, distance: NDArray[np.float32] | None) -> None:
    """Set the distance (h, w) of the flames from the camera, m; 0 or None: no flames."""
    group = stage.root.get(_GROUP)
    if group is None:
        return
    rows = np.zeros((1, 1), np.float32) if distance is None else distance[::-1]
    image = group.nodes[_IMAGE].image
    if tuple(image.size) != rows.shape[::-1]:
        image.scale(*rows.shape[::-1])
    image.pixels.foreach_set(np.repeat(rows.astype(np.float32).ravel(), 4))
    image.update()


def _shader_group(stage: Stage) -> bpy.types.NodeTree:
    """Create the node group and its image once per scene."""
    if stage.root.get(_GROUP) is not None:
        return stage.root[_GROUP]
    group = owned.mark(bpy.data.node_groups.new("Firetwin Flame Gaps", "ShaderNodeTree"))
    stage.root[_GROUP] = group
    group.interface.new_socket("Before", in_out="OUTPUT", socket_type="NodeSocketFloat")
    tree = nodes.Tree(group)
    image = owned.mark(bpy.data.images.new("Firetwin Flame Distance", 1, 1, float_buffer=True, is_data=True))
    image.pixels.foreach_set(np.zeros(4, np.float32))
    window = tree.output("ShaderNodeTexCoord", name="Window")
    texture = tree.node(
        "ShaderNodeTexImage", {"Vector": window}, image=image, interpolation="Closest", extension="EXTEND"
    )
    texture.name = _IMAGE
    limit, _, _ = tree.separate(tree.pick(texture, "Color"))
    tree.finish({"Before": tree.output("ShaderNodeCameraData", name="View Distance") < limit})
    return tree.node_tree
