"""Landmarks in Blender's VR viewer: stations, the ignition, and the moving head of the fire.

The add-on "VR Scene Inspection" stores them with the scene. A landmark at a fixed position is on the ground
and looks towards the ignition. The head's landmark follows an empty, which is owned by the artist.
"""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Vector

from ...progress import count
from .. import camera_targets, go_to, landmarks, navigation, place_names, working

NO_VIEWER = "Enable VR Scene Inspection in Blender's preferences (Add-ons) first"
MOST = 100  # stations


class FIRETWIN_OT_vr_landmarks(bpy.types.Operator):
    """Add stations, the ignition and the moving head of the fire as landmarks of Blender's VR viewer"""

    bl_idname = "firetwin.vr_landmarks"
    bl_label = "Add VR landmarks"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not hasattr(context.scene, "vr_landmarks"):
            cls.poll_message_set(NO_VIEWER)
            return False
        return navigation.can_navigate(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, panel = context.scene, context.scene.firetwin
        began = landmarks.find(panel, landmarks.IGNITION)
        names = [each.name for each in place_names.list_stations(panel)[:MOST]]
        places = {name: where for name in names if (where := go_to.find_position(scene, name)) is not None}
        for name, where in places.items():
            _add_fixed_landmark(scene, name, where, began)
        if began is not None:
            _add_fixed_landmark(scene, landmarks.IGNITION, began, None)
            _add_head_landmark(scene, began)
        total = len(places) + (0 if began is None else 2)
        if not total:
            self.report({"WARNING"}, "The run has neither stations nor fire")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Added {count(total, 'landmark')} to the tab VR")
        return {"FINISHED"}


def _select_landmark(scene: bpy.types.Scene, name: str) -> bpy.types.PropertyGroup:
    """Select the landmark of this name, after creating it if necessary."""
    index = next((k for k, each in enumerate(scene.vr_landmarks) if each.name == name), None)
    if index is None:
        index = len(scene.vr_landmarks)
        scene.vr_landmarks.add().name = name
    scene.vr_landmarks_selected = index
    return scene.vr_landmarks[index]


def _add_fixed_landmark(scene: bpy.types.Scene, name: str, where: Vector, to: Vector | None) -> None:
    """Add a landmark on the ground that looks at a point; without one it looks north."""
    found = _select_landmark(scene, name)
    found.type = "CUSTOM"
    found.base_pose_location = where
    found.base_pose_angle = 0.0 if to is None else heading(to - where)


def _add_head_landmark(scene: bpy.types.Scene, began: Vector) -> None:
    """Add a landmark on an empty that follows the head of the fire and looks in its direction of travel."""
    track = landmarks.head_track(scene.firetwin)
    for old in [obj for obj in scene.objects if obj.name == landmarks.HEAD and obj.type == "EMPTY"]:
        bpy.data.objects.remove(old)
    empty = camera_targets.create_moving_empty(scene, landmarks.HEAD, track)
    empty.rotation_euler.z = heading(Vector(track[-1]) - began)
    found = _select_landmark(scene, landmarks.HEAD)
    found.type = "OBJECT"
    found.base_pose_object = empty


def heading(way: Vector) -> float:
    """Return the rotation about the vertical, rad, that turns north into this direction."""
    return math.atan2(-way.x, way.y) if np.hypot(way.x, way.y) > 0.0 else 0.0


classes = (FIRETWIN_OT_vr_landmarks,)
