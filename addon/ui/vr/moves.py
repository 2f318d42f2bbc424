"""Operators of the controllers: play, time, next landmark, and a turn in steps."""

from __future__ import annotations

import time

import bpy
from mathutils import Quaternion

from .. import panel_state, working
from . import landmark_list, session

_SECONDS = 10.0  # s to run through the whole film with the thumbstick at its end


class InSession:
    """An operator of a session that shows a built scene."""

    @classmethod
    def poll(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
        """Return whether it can be used; otherwise set the poll message."""
        if not session.is_running():
            cls.poll_message_set("Start VR first")
            return False
        return panel_state.require(cls, context)


class FIRETWIN_OT_vr_play(InSession, bpy.types.Operator):
    """Play the film in the headset, or pause it"""

    bl_idname = "firetwin.vr_play"
    bl_label = "Play or pause in VR"
    bl_options = {"INTERNAL"}

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        with context.temp_override(window=context.window_manager.windows[0]):
            bpy.ops.screen.animation_play()
        return {"FINISHED"}


class FIRETWIN_OT_vr_time(InSession, bpy.types.Operator):
    """Move the time of the film with the thumbstick, faster if it is pushed farther"""

    bl_idname = "firetwin.vr_time"
    bl_label = "Move time in VR"
    bl_options = {"INTERNAL"}

    direction: bpy.props.IntProperty(name="Direction", default=1, min=-1, max=1)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._last, self._exact = time.monotonic(), float(context.scene.frame_current)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type != "XR_ACTION":
            return {"PASS_THROUGH"}
        if event.xr.action != self._action():
            return {"PASS_THROUGH"}
        if event.value == "RELEASE" or not session.is_running():
            return {"FINISHED"}
        now = time.monotonic()
        self._move(context.scene, abs(event.xr.state[0]) * (now - self._last))
        self._last = now
        return {"RUNNING_MODAL"}

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        """Move by one frame."""
        self._exact = float(context.scene.frame_current)
        self._move(context.scene, _SECONDS / max(context.scene.firetwin.frames, 1))
        return {"FINISHED"}

    def _action(self) -> str:
        """Return the name of the controller's action that calls this operator."""
        return "later" if self.direction > 0 else "earlier"

    def _move(self, scene: bpy.types.Scene, seconds: float) -> None:
        frames = scene.firetwin.frames
        self._exact += self.direction * frames * seconds / _SECONDS
        self._exact = min(max(self._exact, 1.0), float(frames))
        frame = round(self._exact)
        if frame != scene.frame_current:
            scene.frame_set(frame)


class FIRETWIN_OT_vr_landmark(InSession, bpy.types.Operator):
    """Cut to the next or previous landmark: head of the fire, ignition, cameras and stations"""

    bl_idname = "firetwin.vr_landmark"
    bl_label = "Go to landmark in VR"
    bl_options = {"INTERNAL"}

    step: bpy.props.IntProperty(name="Step", default=1)
    name: bpy.props.StringProperty(name="Name", description="Name of the landmark; empty: step through them")

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        name = self.name or _neighbour(context.scene, self.step)
        if not name or not session.stand(context, name):
            self.report({"WARNING"}, f'No landmark "{name}" in this scene')
            return {"CANCELLED"}
        return {"FINISHED"}


def _neighbour(scene: bpy.types.Scene, step: int) -> str:
    """Return the landmark after (or before) the present one; the list is a ring."""
    names, current = landmark_list.names(scene), scene.firetwin.vr_landmark
    if not names:
        return ""
    return names[(names.index(current) + step) % len(names)] if current in names else names[0]


class FIRETWIN_OT_vr_turn(InSession, bpy.types.Operator):
    """Turn the viewer by the angle of a snap turn"""

    bl_idname = "firetwin.vr_turn"
    bl_label = "Turn in VR"
    bl_options = {"INTERNAL"}

    direction: bpy.props.IntProperty(name="Direction", description="1: left, -1: right", default=1)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        state = context.window_manager.xr_session_state
        turn = Quaternion((0.0, 0.0, 1.0), self.direction * context.scene.firetwin.vr_turn)
        viewer, origin = state.viewer_pose_location.copy(), state.navigation_location.copy()
        state.navigation_location = viewer + turn @ (origin - viewer)
        state.navigation_rotation = turn @ state.navigation_rotation
        return {"FINISHED"}


classes = (FIRETWIN_OT_vr_play, FIRETWIN_OT_vr_time, FIRETWIN_OT_vr_landmark, FIRETWIN_OT_vr_turn)
