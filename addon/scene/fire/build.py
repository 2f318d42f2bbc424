"""Flames in the scene: a point mesh on which geometry nodes instance billboards along the current front."""

from __future__ import annotations

from dataclasses import fields

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from .. import clock, flame_field
from ..forest.stand import Stand
from . import firebrand_nodes, flame_bake, flame_light, flames, fronts, lamp_objects, material, observed

CARDS = 4
SHOWN = 1.0, 0.25, 0.02, 1.0  # red, green, blue and alpha in the solid view
_FLAMES = "flames"
_NAMES = {"length": "flame_length", "width": "flame_width"}


def build(shot: Shot, stage: Stage, grown: Stand | None = None) -> bpy.types.Object | None:
    """Build "Firetwin Flames", "Firetwin Firebrands" and their lights (if flames are on), and front lines.

    The points carry the attributes of `flames.Points` (`length` as `flame_length`, `width` as `flame_width`).
    """
    collection = stage.part("Fire")
    observed.build(shot, stage, collection)
    fronts.build(shot, stage, collection)
    if not shot.settings.fire.flames:
        return None
    points = flames.front_flames(shot, grown)
    obj = owned.add(collection, "Flames", _mesh(points), _FLAMES)
    modifier = obj.modifiers.new("Firetwin Flames", "NODES")
    modifier.node_group = node_group(shot, stage, build_cards(shot, stage))
    obj.color = SHOWN
    _show_to_camera_only(obj)
    firebrand_nodes.build(shot, stage, points, collection)
    lit = owned.child(collection, "Lamps")
    lamp_objects.build(shot, lit)
    flame_light.build(shot, grown, lit)
    flame_bake.build(shot, stage, collection, torching_crowns(stage))
    return obj


def _mesh(points: flames.Points) -> bpy.types.Mesh:
    data = create_mesh("Firetwin Flames", points.position)
    for field in fields(points):
        if field.name not in ("position", "heat"):
            name = _NAMES.get(field.name, field.name)
            add_attribute(data, name, "FLOAT", getattr(points, field.name))
    return data


def torching_crowns(stage: Stage) -> flames.Points | None:
    """Return the torching crowns of a built scene; None without flames."""
    obj = next((each for each in stage.objects_of("Fire") if owned.is_ours(each, _FLAMES)), None)
    if obj is None or "crown" not in obj.data.attributes:
        return None
    crowns = np.flatnonzero(_values(obj.data, "crown") > 0.0)
    place = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", place)
    rest = {field.name: _values(obj.data, field.name)[crowns] for field in fields(flames.Points)[1:]}
    return flames.Points(position=place.reshape(-1, 3)[crowns].astype(np.float64), **rest)


def _values(data: bpy.types.Mesh, name: str) -> NDArray[np.float64]:
    """Return the values (n,) of an attribute of flames; 0 if the mesh does not have it."""
    values = np.zeros(len(data.vertices), np.float32)
    attribute = data.attributes.get(_NAMES.get(name, name))
    if attribute is not None:
        attribute.data.foreach_get("value", values)
    return values.astype(np.float64)


def _show_to_camera_only(obj: bpy.types.Object) -> None:
    """Make flames visible to camera rays only, so that they cast no shadow and light nothing."""
    obj.visible_shadow = obj.visible_diffuse = obj.visible_volume_scatter = False
    obj.lightgroup = nodes.FIRE


def build_cards(shot: Shot, stage: Stage) -> bpy.types.Collection:
    """Create billboards one metre high and wide on z = 0: flat, curved and crossed; linked to no scene."""
    collection, flame = owned.library("Flame Cards"), material.build(shot, stage)
    for index in range(CARDS):
        vertices, faces, cards = _card_geometry(index)
        data = create_mesh(f"Firetwin Flame Card {index}", vertices, faces, flat=True)
        add_attribute(data, "card", "FLOAT_VECTOR", cards)
        data.materials.append(flame)
        obj = owned.add(collection, f"Flame Card {index}", data)
        obj.color = SHOWN
        _show_to_camera_only(obj)
    return collection


def _card_geometry(index: int) -> tuple[list, list, list]:
    """Return vertices, faces and card coordinates of a billboard."""
    sheets = [(0.0, 0.0)] if index == 0 else [(0.0, 0.25)] if index == 1 else [(0.0, -0.25)]
    if index == 3:
        sheets = [(-0.5, 0.0), (0.7, 0.1)]  # rotation about the vertical, curvature
    vertices: list[tuple[float, float, float]] = []
    faces: list[tuple[int, int, int, int]] = []
    cards: list[tuple[float, float, float]] = []
    steps = 4
    for turn, bow in sheets:
        start = len(vertices)
        for i in range(steps + 1):
            for j in range(steps + 1):
                across, up = 2.0 * i / steps - 1.0, j / steps
                x, y = 0.5 * across, bow * (across * across - 0.5) + 0.12 * bow * up
                vertices.append(
                    (x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), up)
                )
                cards.append((across, up, 0.0))
        row = steps + 1
        faces += [
            (a, a + row, a + row + 1, a + 1)
            for a in (start + i * row + j for i in range(steps) for j in range(steps))
        ]
    return vertices, faces, cards


def node_group(shot: Shot, stage: Stage, shapes: bpy.types.Collection) -> bpy.types.NodeTree:
    """Build geometry nodes: flaming points -> billboards that face the camera, tilt, grow and decay.

    Flames that are entirely within the field of flames have no billboard: it would be transparent.
    """
    tree, entry = nodes.geometry("Firetwin Flames")

    def named(name: str) -> nodes.Value:
        return tree.output("GeometryNodeInputNamedAttribute", {"Name": name}, data_type="FLOAT")

    age = clock.geometry_time(tree, shot) - named("arrival_time")
    part = age / named("residence")
    outside = tree.math("ADD", age < 0.0, tree.math("SUBTRACT", 1.0, part < 1.0), clamp=True)
    life = part.ramp(0.0, 0.2, 0.25, 1.0) * part.ramp(0.6, 1.0, 1.0, 0.2)
    seed = named("seed")
    camera = tree.output("GeometryNodeInputActiveCamera")
    eye = tree.output("GeometryNodeObjectInfo", {"Object": camera}, "Location", transform_space="ORIGINAL")
    east, north, _ = tree.separate(tree.vector("SUBTRACT", eye, tree.output("GeometryNodeInputPosition")))
    yaw = tree.math("ARCTAN2", north, east) + (np.pi / 2.0) + (seed - 0.5) * 0.9
    facing = tree.output("FunctionNodeEulerToRotation", {"Euler": tree.combine(0.0, 0.0, yaw)})
    east_wind, north_wind = shot.wind
    leaning = tree.input("Lean", 1.0, "Factor on how far the wind tilts flames", "Shape")
    axis = (-north_wind, east_wind, 0.0) if np.hypot(east_wind, north_wind) > 0.0 else (1.0, 0.0, 0.0)
    lean = tree.output("FunctionNodeAxisAngleToRotation", {"Axis": axis, "Angle": named("tilt") * leaning})
    turned = tree.output(
        "FunctionNodeRotateRotation", {"Rotation": facing, "Rotate By": lean}, rotation_space="GLOBAL"
    )
    wider = tree.input("Width", 1.0, "Factor on how wide flames are", "Size")
    longer = tree.input("Length", 1.0, "Factor on how long flames are", "Size")
    width = named("flame_width") * life * wider
    length = named("flame_length") * life * longer
    scale = tree.combine(width, width, length)
    within = flame_field.distance_beyond(tree, stage) < -(length + width)
    several = tree.output(
        "GeometryNodeCollectionInfo",
        {"Collection": shapes, "Separate Children": True, "Reset Children": True},
    )
    shape = tree.math("FLOOR", tree.math("FRACT", seed * 977.0) * (CARDS - 0.001))
    placed = tree.output(
        "GeometryNodeInstanceOnPoints",
        {
            "Points": entry,
            "Selection": tree.math("ADD", outside, within) < 0.5,
            "Instance": several,
            "Pick Instance": True,
            "Instance Index": shape,
            "Rotation": turned,
            "Scale": scale,
        },
    )
    tree.geometry(placed)
    return tree.node_tree
