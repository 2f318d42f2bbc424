"""Distances of flames and of opaque smoke in the cells of a picture, which surfaces compare to their own.

Foliage in front of flames has gaps that are smaller than pixels. The depth of the ray through a pixel's
centre shows a gap as a square of one pixel, or not at all. Surfaces therefore compare their distance to that
of the flames for every ray. Surfaces behind opaque smoke are not seen, and need no light. The integrated
renderer stores both distances in an image.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender import nodes, owned
from ..blender.owned import Stage

AOV = "Firetwin Before Flames"
_GROUP, _IMAGE = "cell distances", "Cell Distances"
_HIDDEN_LIGHT = 0.05
"""Radiance of hidden surfaces. It is similar to lit ones, as the denoiser would preserve an edge."""


def write(tree: nodes.Tree, stage: Stage, shader: nodes.Value) -> nodes.Value:
    """Write 1 to the AOV where the surface is nearer than the flames in its pixel, else 0.

    Returns
    -------
    The `shader`; for rays from the camera to a surface behind opaque smoke, an even colour in its place.
    """
    distances = tree.node("ShaderNodeGroup", node_tree=_shader_group(stage))
    tree.aov(AOV, tree.pick(distances, "Before"), colour=False)
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    even = tree.emission((1.0, 1.0, 1.0), _HIDDEN_LIGHT)
    return tree.mix_shader(camera * tree.pick(distances, "Hidden"), shader, even)


def set_distances(
    stage: Stage, flames: NDArray[np.float32] | None = None, smoke: NDArray[np.float32] | None = None
) -> None:
    """Set the distances (h, w) of flames and of opaque smoke from the camera, m.

    Parameters
    ----------
    flames
        0, or None: no flames.
    smoke
        Infinite, or None: not opaque.
    """
    group = stage.root.get(_GROUP)
    if group is None:
        return
    height, width = next((each.shape for each in (flames, smoke) if each is not None), (1, 1))
    pixels = np.zeros((height, width, 4), np.float32)
    pixels[..., 0] = 0.0 if flames is None else flames[::-1]
    pixels[..., 1] = 0.0 if smoke is None else 1.0 / smoke[::-1]
    image = group.nodes[_IMAGE].image
    if tuple(image.size) != (width, height):
        image.scale(width, height)
    image.pixels.foreach_set(pixels.ravel())
    image.update()


def _shader_group(stage: Stage) -> bpy.types.NodeTree:
    """Create the node group and its image once per scene.

    The image has the distance of flames and 1 / the distance of smoke: a black one, as Blender shows an image
    that a saved scene lost, hides nothing.
    """
    if stage.root.get(_GROUP) is not None:
        return stage.root[_GROUP]
    group = owned.mark(bpy.data.node_groups.new(f"Firetwin {_IMAGE}", "ShaderNodeTree"))
    stage.root[_GROUP] = group
    for name in ("Before", "Hidden"):
        group.interface.new_socket(name, in_out="OUTPUT", socket_type="NodeSocketFloat")
    tree = nodes.Tree(group)
    image = owned.mark(bpy.data.images.new(f"Firetwin {_IMAGE}", 1, 1, float_buffer=True, is_data=True))
    window = tree.output("ShaderNodeTexCoord", name="Window")
    texture = tree.node(
        "ShaderNodeTexImage", {"Vector": window}, image=image, interpolation="Closest", extension="EXTEND"
    )
    texture.name = _IMAGE
    flames, near_smoke, _ = tree.separate(tree.pick(texture, "Color"))
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    tree.finish({"Before": distance < flames, "Hidden": distance * near_smoke > 1.0})
    return tree.node_tree
