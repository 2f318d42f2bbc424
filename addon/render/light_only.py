"""Light-only materials: shaders of data layers are disconnected while a render needs only light and AOVs.

Cycles evaluates the nodes of an AOV for camera rays only, unless a shader uses these nodes too: then it
evaluates them for every ray, even if the weight of the shader is 0. Infrared shaders use the nodes of an AOV.
Without them the example's frame takes 1.1 CPU seconds less, and its pixels are identical. Infrared radiance
in the AOV of surfaces is disconnected as well if no requested pass shows it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager

import bpy

from ..blender import nodes, owned
from . import layers


@contextmanager
def light_only(names: Collection[str], infrared: bool = True) -> Iterator[None]:
    """Disconnect the data shaders of our materials, if the view layers of all these passes render light.

    Parameters
    ----------
    infrared
        Keep infrared radiance in the AOV of surfaces.
    """
    if any(layers.rendered(name).shading != "light" for name in names):
        yield
        return
    trees = [tree for tree in bpy.data.node_groups if owned.is_ours(tree)]
    inputs = [node.inputs[2] for tree in trees for node in _switches(tree)]
    if not infrared:
        inputs += [socket for tree in trees for socket in _infrared_inputs(tree)]
    cut = [(each.id_data, each.links[0].from_socket, each) for each in inputs]
    for tree, _, socket in cut:
        tree.links.remove(socket.links[0])
    try:
        yield
    finally:
        for tree, source, socket in cut:
            tree.links.new(source, socket)


def _switches(tree: bpy.types.NodeTree) -> Iterator[bpy.types.Node]:
    """Yield the nodes of `nodes.switch` that have a data shader."""
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeMixShader" and node.inputs[0].is_linked and node.inputs[2].is_linked:
            factor = node.inputs[0].links[0].from_node
            if (
                factor.bl_idname == "ShaderNodeAttribute"
                and factor.attribute_type == "VIEW_LAYER"
                and factor.attribute_name in (nodes.THERMAL, nodes.MASKS)
            ):
                yield node


def _infrared_inputs(tree: bpy.types.NodeTree) -> Iterator[bpy.types.NodeSocket]:
    """Yield the sockets through which `nodes.thermal_switch` writes infrared radiance to an AOV."""
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeOutputAOV" and node.aov_name == nodes.SURFACE:
            channel = node.inputs["Color"].links[0].from_node.inputs["Z"]
            if channel.is_linked:
                yield channel
