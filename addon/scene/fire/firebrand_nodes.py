"""Firebrands in the scene: a mesh of trajectory points; geometry nodes draw a streak for each live one."""

from __future__ import annotations

import bpy
import numpy as np

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from . import firebrand_material, firebrands, flames

_PIXELS = 0.8  # minimum width of a streak in pixels; narrower streaks are dimmed instead
_FAR = 2.0 * firebrands.REACH
"""m from the camera beyond which no streak is drawn: a firebrand there adds less than 0.1 K to a pixel. In a
satellite image hundreds of wide streaks would overlap, more transparent surfaces than Cycles traces, which
gives black pixels."""


def build(
    shot: Shot, stage: Stage, points: flames.Points, collection: bpy.types.Collection
) -> bpy.types.Object | None:
    """Build "Firetwin Firebrands" from the result of `firebrands.fly`; None without a camera nearby.

    Vertex i k + j is point j of the trajectory of firebrand i. All have the float attributes `start`,
    `birth`, `life` (s after the first frame, s) and `size` (m).
    """
    flights = firebrands.fly(shot, points)
    if flights is None:
        return None
    count, each = flights.place.shape[:2]
    data = create_mesh("Firetwin Firebrands", flights.place.reshape(count * each, 3))
    for name in ("start", "birth", "life", "size"):
        add_attribute(data, name, "FLOAT", np.repeat(getattr(flights, name), each))
    obj = owned.add(collection, "Firebrands", data)
    modifier = obj.modifiers.new("Firetwin Firebrands", "NODES")
    modifier.node_group = _node_group(shot, stage, flights, shot.pixel[0])
    _show_to_camera_only(obj)
    return obj


def _show_to_camera_only(obj: bpy.types.Object) -> None:
    """Make streaks visible to camera rays only."""
    obj.visible_shadow = obj.visible_diffuse = obj.visible_glossy = False
    obj.visible_volume_scatter = False
    obj.lightgroup = nodes.FIRE


def _node_group(shot: Shot, stage: Stage, flights: firebrands.Flights, pixel: float) -> bpy.types.NodeTree:
    """Build geometry nodes: trajectory points -> a streak per live firebrand, at least `pixel` rad wide."""
    count, each = flights.place.shape[:2]
    tree, entry = nodes.geometry("Firetwin Firebrands")
    paths = tree.pick(entry, "Geometry")
    index = tree.output("GeometryNodeInputIndex") * float(each)

    def sampled(value: nodes.Value, at: nodes.Value, kind: str = "FLOAT") -> nodes.Value:
        inputs = {"Geometry": paths, "Value": value, "Index": tree.math("ROUND", at)}
        return tree.output("GeometryNodeSampleIndex", inputs, data_type=kind, domain="POINT", clamp=True)

    def named(name: str) -> nodes.Value:
        value = tree.output("GeometryNodeInputNamedAttribute", {"Name": name}, data_type="FLOAT")
        return sampled(value, index)

    # Times count from the first frame: seconds since the start of the run would exceed float precision.
    time = (tree.output("GeometryNodeInputSceneTime", name="Frame") - 1.0) * shot.frames.step
    after = (time - named("start")) / flights.step
    part = (time - named("birth")) / named("life")
    low = tree.math("MINIMUM", tree.math("MAXIMUM", tree.math("FLOOR", after), 0.0), each - 2.0)
    position = tree.output("GeometryNodeInputPosition")
    before, behind = (sampled(position, index + low + k, "FLOAT_VECTOR") for k in (0.0, 1.0))
    way = tree.vector("SUBTRACT", behind, before)
    place = tree.vector("ADD", before, _scale_vector(tree, way, (after - low).clamp()))
    pieces = tree.output("GeometryNodePoints", {"Count": count, "Position": place, "Radius": 0.0})
    camera = tree.output("GeometryNodeInputActiveCamera")
    eye = tree.output("GeometryNodeObjectInfo", {"Object": camera}, "Location", transform_space="ORIGINAL")
    distance = tree.vector("DISTANCE", eye, place, name="Value")
    dead = distance > _FAR
    for out in (part < 0.0, part > 1.0, after < 0.0, after > each - 1.0):
        dead = tree.math("MAXIMUM", dead, out)
    larger = tree.input("Size", 1.0, "Factor on the size of the pieces", "Size")
    shutter = tree.input("Shutter", firebrands.exposure_time(shot), "Exposure time (s) of a streak", "Size")
    size = named("size") * larger
    width = tree.math("MAXIMUM", size, distance * (_PIXELS * pixel))
    length = width + tree.vector("LENGTH", way, name="Value") * (shutter / flights.step)
    cover = (size * size / (width * length)).clamp()
    kelvin = part.ramp(0.0, 1.0, firebrand_material.FRESH, firebrand_material.COLD)
    turn = tree.output("FunctionNodeAlignRotationToVector", {"Vector": way}, axis="Z")
    scale = tree.combine(width, width, length)
    for name, value, kind in (
        ("dead", dead, "FLOAT"),
        ("cover", cover, "FLOAT"),
        ("kelvin", kelvin, "FLOAT"),
        ("shine", (1.0 - part).clamp().power(1.5), "FLOAT"),
        ("stretch", scale, "FLOAT_VECTOR"),
        ("turn", turn, "QUATERNION"),
    ):
        inputs = {"Geometry": pieces, "Name": name, "Value": value}
        pieces = tree.output("GeometryNodeStoreNamedAttribute", inputs, data_type=kind, domain="POINT")

    def stored(name: str, kind: str = "FLOAT") -> nodes.Value:
        return tree.output("GeometryNodeInputNamedAttribute", {"Name": name}, data_type=kind)

    alive = tree.output(
        "GeometryNodeDeleteGeometry", {"Geometry": pieces, "Selection": stored("dead") > 0.5}, domain="POINT"
    )
    placed = tree.output(
        "GeometryNodeInstanceOnPoints",
        {
            "Points": alive,
            "Instance": tree.output(
                "GeometryNodeObjectInfo", {"Object": _streak_object(shot, stage)}, "Geometry"
            ),
            "Rotation": stored("turn", "QUATERNION"),
            "Scale": stored("stretch", "FLOAT_VECTOR"),
        },
    )
    tree.geometry(placed)
    return tree.node_tree


def _scale_vector(tree: nodes.Tree, vector: nodes.Value, by: nodes.Value) -> nodes.Value:
    inputs: dict[str | int, nodes.Value] = {0: vector, "Scale": by}
    node = tree.node("ShaderNodeVectorMath", inputs, operation="SCALE")
    return tree.pick(node)


def _streak_object(shot: Shot, stage: Stage) -> bpy.types.Object:
    """Create an octahedron one metre wide and long, linked to no scene."""
    name = "Firetwin Firebrand Streak"
    ends = [(0.0, 0.0, -0.5), (0.0, 0.0, 0.5)]
    waist = [(0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (-0.5, 0.0, 0.0), (0.0, -0.5, 0.0)]
    sides = [(2 + k, 2 + (k + 1) % 4) for k in range(4)]
    faces = [(b, a, 0) for a, b in sides] + [(a, b, 1) for a, b in sides]
    data = owned.mark(create_mesh(name, ends + waist, faces, flat=True))
    data.materials.append(firebrand_material.build(shot, stage))
    obj = owned.mark(bpy.data.objects.new(name, data))
    obj.color = 1.0, 0.42, 0.10, 1.0  # in the solid view
    _show_to_camera_only(obj)
    return obj
