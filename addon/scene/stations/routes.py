"""Routes: lines on the ground of constant width in the picture, coloured by origin."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...run import areas
from ...shot.shot import Shot
from ...shot.stations.drawn_routes import Route
from ..labels import facing, lettering
from ..labels.material import FADE
from . import material

_STEP = 30.0  # maximum distance between points of a line, m
_OVER = 2.0  # height above the ground: m, and half-widths of the line
_SIDE = "side"  # attribute: offset from the middle of the line to a corner of its section, in half-widths

Array = NDArray[np.float64]


def build(shot: Shot, collection: bpy.types.Collection, shown: Sequence[Route]) -> bpy.types.Object | None:
    """Build "Firetwin Routes"; None without routes."""
    lines = [drape_line(shot, each.line) for each in shown]
    tubes = [(_tube(line), each.origin) for line, each in zip(lines, shown, strict=True) if len(line) > 1]
    if not tubes:
        return None
    points, sides, faces, looks, start = [], [], [], [], 0
    for (place, side, quads), origin in tubes:
        points.append(place)
        sides.append(side)
        faces.append(quads + start)
        looks += [list(material.ACCENTS).index(origin)] * len(quads)
        start += len(place)
    corners, quads = np.concatenate(points), np.concatenate(faces)
    data = create_mesh("Firetwin Routes", corners, quads, flat=True, material_index=looks)
    add_attribute(data, _SIDE, "FLOAT_VECTOR", np.concatenate(sides))
    for look in material.routes(shot):
        data.materials.append(look)
    obj = owned.add(collection, "Routes", data)
    lettering.camera_rays_only(obj)
    modifier = obj.modifiers.new("Firetwin Routes", "NODES")
    modifier.node_group = _node_group(shot)
    return obj


def drape_line(shot: Shot, line: Array) -> Array:
    """Drape a line (degrees east and north) on the ground: points (n, 3), m, clipped to the ground."""
    fields = shot.ground.fields
    longitude = areas.turned(line[:, 0], float(np.mean(fields.longitude)))
    corners = shot.ground.point(line[:, 1], longitude)[:, :2]
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    along = np.linspace(0.0, length[-1], max(int(np.ceil(length[-1] / _STEP)) + 1, 2))
    north, east = (np.interp(along, length, each) for each in (line[:, 1], longitude))
    inside = (north >= fields.latitude.min()) & (north <= fields.latitude.max())
    inside &= (east >= fields.longitude.min()) & (east <= fields.longitude.max())
    return shot.ground.point(north[inside], east[inside])


def _tube(line: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Make a four-sided tube around a line (n, 3): points and offsets (4n, 3), and faces (4(n - 1), 4)."""
    along = np.gradient(line, axis=0)
    along[:, 2] = 0.0
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    left, up = np.stack([-along[:, 1], along[:, 0], 0.0 * along[:, 0]], axis=-1), np.array([0.0, 0.0, 1.0])
    side = np.stack([left, up + 0.0 * left, -left, -up + 0.0 * left], axis=1)
    ring, after = np.arange(4), np.roll(np.arange(4), -1)
    first = 4 * np.arange(len(line) - 1)[:, None]
    quads = np.stack([first + ring, first + after, first + 4 + after, first + 4 + ring], axis=-1)
    return np.repeat(line, 4, axis=0), side.reshape(-1, 3), quads.reshape(-1, 4)


def _node_group(shot: Shot) -> bpy.types.NodeTree:
    """Make geometry nodes that scale the width of lines with the view, and fade lines with distance."""
    settings = shot.settings.stations
    width, height = shot.settings.render.resolution
    tree, entry = nodes.geometry("Firetwin Routes")
    wide = tree.input(
        "Width", settings.route_width, "Width of a route as a fraction of the height of the picture", "Routes"
    )
    gone = tree.input("Distance", settings.distance, "Distance at which routes vanish (m)", "Routes")
    view = facing.read_camera(tree)
    fade = tree.mix(view.flat, view.distance.ramp(gone * 0.5, gone, 1.0, 0.0), 1.0)
    inputs = {"Geometry": entry, "Name": FADE, "Value": fade}
    kept = tree.output("GeometryNodeStoreNamedAttribute", inputs, data_type="FLOAT", domain="POINT")
    side = tree.output("GeometryNodeInputNamedAttribute", {"Name": _SIDE}, data_type="FLOAT_VECTOR")
    half = view.wide * wide * (0.5 * height / width)
    across = tree.vector("MULTIPLY", side, tree.combine(half, half, half))
    over = tree.combine(0.0, 0.0, half * _OVER + _OVER)
    moved = {"Geometry": kept, "Offset": tree.vector("ADD", across, over)}
    tree.geometry(tree.output("GeometryNodeSetPosition", moved))
    return tree.node_tree
