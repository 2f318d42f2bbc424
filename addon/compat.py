"""The one place that knows how Blender versions differ (4.5 LTS to 5.2 LTS).

Features are looked for, version numbers are not compared.
"""

from __future__ import annotations

import warnings
from typing import Any

import bpy

_SOCKET_ALIASES = {"Fac": "Factor", "Factor": "Fac"}


def eevee_id() -> str:
    """Identifier of the EEVEE engine: BLENDER_EEVEE_NEXT in 4.5, BLENDER_EEVEE from 5.0."""
    engines = bpy.types.RenderSettings.bl_rna.properties["engine"].enum_items
    return "BLENDER_EEVEE_NEXT" if "BLENDER_EEVEE_NEXT" in engines else "BLENDER_EEVEE"


def new_fcurve(datablock: bpy.types.ID, data_path: str, index: int = 0) -> bpy.types.FCurve:
    """An empty F-curve on `datablock`, which gets an action of its own when it has none.

    Legacy actions (`action.fcurves`) are gone in 5.0; slotted ones work from 4.4 on.
    """
    animation = datablock.animation_data or datablock.animation_data_create()
    if animation.action is None:
        animation.action = bpy.data.actions.new(f"{datablock.name} action")
    curve = animation.action.fcurve_ensure_for_datablock(datablock, data_path, index=index)
    curve.keyframe_points.clear()
    return curve


def fcurves(datablock: bpy.types.ID) -> list[bpy.types.FCurve]:
    """All F-curves that animate `datablock`."""
    animation = datablock.animation_data
    if animation is None or animation.action is None:
        return []
    return [
        curve
        for layer in animation.action.layers
        for strip in layer.strips
        for bag in strip.channelbags
        if bag.slot == animation.action_slot
        for curve in bag.fcurves
    ]


def node_tree(owner: bpy.types.Material | bpy.types.World | bpy.types.Light) -> bpy.types.NodeTree:
    """The empty shader tree of a new material, world or light (`use_nodes` is deprecated in 5.0)."""
    if owner.node_tree is None or not owner.use_nodes:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def set_modifier_input(modifier: bpy.types.NodesModifier, identifier: str, value: Any) -> None:
    """Set an input of a geometry-nodes modifier; 5.2 moved them from ID properties to RNA."""
    inputs = getattr(getattr(modifier, "properties", None), "inputs", None)
    if inputs is not None:
        getattr(inputs, identifier).value = value
    else:
        modifier[identifier] = value


def find_socket(sockets: bpy.types.bpy_prop_collection, name: str | int) -> bpy.types.NodeSocket:
    """The enabled socket called `name`, else the one with that identifier, else that place in the row.

    Indexing by name would return hidden sockets in 4.5 and not find them in 5.2. Factor and Fac are one name.
    """
    usable = [socket for socket in sockets if socket.enabled]
    if isinstance(name, int):
        return usable[name]
    for wanted in (name, _SOCKET_ALIASES.get(name)):
        for socket in usable:
            if wanted is not None and wanted in (socket.name, socket.identifier):
                return socket
    known = ", ".join(socket.name for socket in usable)
    raise KeyError(f"no socket {name!r}; there are: {known}")


def set_sky(node: bpy.types.ShaderNodeTexSky, elevation: float, rotation: float, dust: float) -> None:
    """Make a sky texture a physical sky without sun disc.

    Parameters
    ----------
    elevation, rotation
        Height of the sun over the horizon and its clockwise bearing from +y, radians.
    dust
        Aerosol density, 1 for urban haze.
    """
    kinds = node.bl_rna.properties["sky_type"].enum_items
    node.sky_type = "NISHITA" if "NISHITA" in kinds else "MULTIPLE_SCATTERING"
    node.sun_disc = False
    node.sun_elevation = elevation
    node.sun_rotation = rotation
    setattr(node, "dust_density" if hasattr(node, "dust_density") else "aerosol_density", dust)
