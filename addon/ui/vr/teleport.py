"""Teleport to the ground that the left controller points at.

Blender's own teleport does not know the scale of a session, stops at the crowns of trees, and refuses slopes
of more than 30 degrees.
"""

from __future__ import annotations

import bpy
from mathutils import Quaternion, Vector

from ...blender import owned
from ...scene.camera import ground_raycast
from .. import working
from . import display, session
from .landmark_list import EYE
from .moves import InSession

_LEFT = 0  # first controller of the pose actions


class FIRETWIN_OT_vr_teleport(InSession, bpy.types.Operator):
    """Teleport to the ground that the left controller points at, when its trigger is released"""

    bl_idname = "firetwin.vr_teleport"
    bl_label = "Teleport in VR"
    bl_options = {"INTERNAL"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        context.window_manager.modal_handler_add(self)
        return self.modal(context, event)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type != "XR_ACTION" or event.xr.action != "teleport":
            return {"PASS_THROUGH"}
        if event.value == "RELEASE" or not session.is_running():
            display.show_ray(None)
            return self.execute(context)
        display.show_ray(_find_ray(context))
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        display.show_ray(None)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        ray = _find_ray(context)
        if ray is None:
            self.report({"WARNING"}, "The left controller does not point at the ground")
            return {"CANCELLED"}
        _go(context, ray[1])
        return {"FINISHED"}


def _find_ray(context: bpy.types.Context) -> tuple[Vector, Vector] | None:
    """Return the controller's position and the point on the ground ahead of it; None: it points elsewhere."""
    state, stage = context.window_manager.xr_session_state, owned.find_stage(context.scene)
    if state is None or stage is None:
        return None
    start = Vector(state.controller_aim_location_get(context, _LEFT))
    turn = Quaternion(state.controller_aim_rotation_get(context, _LEFT))
    end = ground_raycast.cast_ray(stage, start, turn @ Vector((0.0, 0.0, -1.0)))
    return None if end is None else (start, end)


def _go(context: bpy.types.Context, ground: Vector) -> None:
    """Place the viewer's eyes above a point on the ground, as high as at a landmark."""
    scene, state = context.scene, context.window_manager.xr_session_state
    place = session.eyes(scene, ground + Vector((0.0, 0.0, EYE)))
    state.navigation_location += place - Vector(state.viewer_pose_location)
    if scene.firetwin.vr_fade:
        display.fade()


classes = (FIRETWIN_OT_vr_teleport,)
