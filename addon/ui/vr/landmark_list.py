"""Landmarks of a VR session: head of the fire, ignition, cameras and stations, in this order."""

from __future__ import annotations

from typing import NamedTuple

import bpy
from mathutils import Vector

from ...blender import owned
from ...scene.camera import ground_raycast
from .. import go_to, landmarks, place_names
from .viewer_landmarks import heading

EYE = 1.7  # m, height of a standing viewer's eyes above the ground (assumed)
_STATIONS = 20  # at most; a list without end cannot be walked through


class Pose(NamedTuple):
    """Position of the viewer's eyes (scene, m), and rotation about the vertical (rad; 0: looks north)."""

    place: Vector
    angle: float


def names(scene: bpy.types.Scene) -> list[str]:
    """Return the names of the landmarks of a scene."""
    cameras = [obj.name for obj in scene.objects if obj.type == "CAMERA"]
    stations = [each.name for each in place_names.list_stations(scene.firetwin)[:_STATIONS]]
    return list(dict.fromkeys((*landmarks.list_names(scene.firetwin), *cameras, *stations)))


def pose(scene: bpy.types.Scene, name: str) -> Pose | None:
    """Return the pose of a viewer at a landmark in the current frame; None: there is no such place.

    The viewer has the position and the direction of a camera. Elsewhere the viewer stands on the ground and
    looks towards the head of the fire; at the head, in its direction of travel.
    """
    obj = scene.objects.get(name)
    if obj is not None and obj.type == "CAMERA":
        matrix = obj.matrix_world
        return Pose(matrix.translation.copy(), heading(-matrix.col[2].to_3d()))
    place = go_to.find_position(scene, name)
    if place is None:
        return None
    place = _on_ground(scene, place)
    head, began = (landmarks.find(scene.firetwin, each) for each in (landmarks.HEAD, landmarks.IGNITION))
    way = Vector((0.0, 0.0, 0.0))
    if name == landmarks.HEAD and began is not None:
        way = place - began
    elif head is not None:
        way = head - place
    return Pose(place + Vector((0.0, 0.0, EYE)), heading(way))


def _on_ground(scene: bpy.types.Scene, place: Vector) -> Vector:
    """Return a place on the ground that 3D views show, whose mesh differs from the run's by its error."""
    stage = owned.find_stage(scene)
    height = None if stage is None else ground_raycast.terrain_height(stage, place)
    return place if height is None else Vector((place.x, place.y, height))
