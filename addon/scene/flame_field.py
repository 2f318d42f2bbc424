"""Share of flames that surfaces and billboards show at a distance, next to flames drawn as a field.

The integrated renderer marches the field up to its camera's reach. Within the reach crowns, ground and
billboards emit no flames; at the reach (`flame_map.FADE`) they fade in as the field fades out. The reach is 0
(no field) in EEVEE, in Blender's own renders, and in scenes that an artist opens.
"""

from __future__ import annotations

import bpy

from ..blender import nodes, owned
from ..blender.owned import Stage
from ..shot.fire.flame_view import FADE

_SHADER, _GEOMETRY = "flame field", "flame field of geometry"
_REACH = "Reach"


def share(tree: nodes.Tree, stage: Stage) -> nodes.Value:
    """Return the share 0..1 of flames that this point of a shader emits: 0 within the field, 1 beyond it."""
    return tree.output("ShaderNodeGroup", (), "Share", node_tree=_shader_group(stage))


def distance_beyond(tree: nodes.Tree, stage: Stage) -> nodes.Value:
    """Return the distance (m) of points in geometry nodes beyond the start of the blend; below 0 within."""
    return tree.output("GeometryNodeGroup", (), "Beyond", node_tree=_geometry_group(stage))


def set_reach(stage: Stage, reach: float) -> None:
    """Set the distance (m) up to which flames are drawn as a field; 0: not at all."""
    for name in (_SHADER, _GEOMETRY):
        group = stage.root.get(name)
        if group is not None:
            group.nodes[_REACH].outputs[0].default_value = reach


def _shader_group(stage: Stage) -> bpy.types.NodeTree:
    """Create the group for shaders once per scene."""
    if stage.root.get(_SHADER) is not None:
        return stage.root[_SHADER]
    tree, reach = _group(stage, _SHADER, "ShaderNodeTree", "Share")
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    low, high = (reach * part for part in FADE)
    beyond = distance.smoothstep(low, high)
    tree.finish({"Share": tree.math("MAXIMUM", beyond, reach < 1.0e-3)})
    return tree.node_tree


def _geometry_group(stage: Stage) -> bpy.types.NodeTree:
    """Create the group for geometry nodes once per scene."""
    if stage.root.get(_GEOMETRY) is not None:
        return stage.root[_GEOMETRY]
    tree, reach = _group(stage, _GEOMETRY, "GeometryNodeTree", "Beyond")
    camera = tree.output("GeometryNodeInputActiveCamera")
    eye = tree.output("GeometryNodeObjectInfo", {"Object": camera}, "Location", transform_space="ORIGINAL")
    position = tree.output("GeometryNodeInputPosition")
    distance = tree.vector("DISTANCE", eye, position, name="Value")
    tree.finish({"Beyond": distance - reach * FADE[0]})
    return tree.node_tree


def _group(stage: Stage, name: str, kind: str, output: str) -> tuple[nodes.Tree, nodes.Value]:
    """Create a group with one output, and its constant for the reach."""
    title = "Firetwin Flame Field" + (" Distance" if kind == "GeometryNodeTree" else "")
    group = owned.mark(bpy.data.node_groups.new(title, kind))
    stage.root[name] = group
    group.interface.new_socket(output, in_out="OUTPUT", socket_type="NodeSocketFloat")
    tree = nodes.Tree(group)
    reach = tree.node("ShaderNodeValue")
    reach.name = reach.label = _REACH
    reach.outputs[0].default_value = 0.0
    return tree, tree.pick(reach)
