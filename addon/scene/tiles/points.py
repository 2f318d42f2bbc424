"""Point clouds of tiles: vertices shown as spheres by geometry nodes, with the ground's material."""

from __future__ import annotations

import bpy
import numpy as np

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, fill_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...tiles.decoded import Decoded
from . import mesh

RADIUS = "radius"
"""Radius of points, m."""
COVERING = 1.0
"""Radius of a point / spacing. Points of a square grid cover their surface from 0.71 on; random points leave
4 % open at 1."""
_GROUP = "tile_points"


def fill(data: bpy.types.Mesh, shot: Shot, tile: Decoded) -> None:
    """Write a tile's points into an empty mesh, with the attributes of the ground, colour and radius."""
    first = len(tile.position) - tile.about.points
    position = np.ascontiguousarray(tile.position[first:])
    fill_mesh(data, position)
    mesh.add_ground(data, shot, position, tile.origin)
    colour = tile.colour[first:] if len(tile.colour) else np.ones((len(position), 4), np.float32)
    add_attribute(data, mesh.COLOUR, "FLOAT_COLOR", colour)
    add_attribute(data, RADIUS, "FLOAT", np.full(len(position), COVERING * tile.about.spacing))


def show(obj: bpy.types.Object, stage: Stage, material: bpy.types.Material) -> None:
    """Show the vertices of an object as points."""
    modifier = obj.modifiers.new("Firetwin Tile Points", "NODES")
    modifier.node_group = _group(stage, material)


def _group(stage: Stage, material: bpy.types.Material) -> bpy.types.NodeTree:
    """Make geometry nodes from vertices to points with this material, once per scene."""
    group = stage.root.get(_GROUP)
    if group is None:
        tree, entry = nodes.geometry("Firetwin Tile Points")
        radius = tree.output("GeometryNodeInputNamedAttribute", {"Name": RADIUS}, data_type="FLOAT")
        shown = tree.output("GeometryNodeMeshToPoints", {"Mesh": entry, "Radius": radius})
        tree.geometry(tree.output("GeometryNodeSetMaterial", {"Geometry": shown, "Material": material}))
        group = stage.root[_GROUP] = owned.mark(tree.node_tree)
    setter = next(node for node in group.nodes if node.bl_idname == "GeometryNodeSetMaterial")
    if setter.inputs["Material"].default_value != material:
        setter.inputs["Material"].default_value = material
    return group
