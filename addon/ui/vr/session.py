"""Start and stop of Blender's VR session with the scale, clipping range and landmark of the scene.

Blender keeps one set of session settings. They get their former values back when the session ends.
"""

from __future__ import annotations

from typing import Any

import bpy
from mathutils import Vector

from ...blender import viewport
from ...scene.live import switch
from .. import navigation, working
from . import display, landmark_list

SCALES = {"LIFE": 1.0, "TABLE": 1000.0}
_CHANGED = (
    "base_pose_type",
    "base_pose_location",
    "base_pose_angle",
    "base_scale",
    "clip_start",
    "clip_end",
    "show_floor",
)
_NEAR = {"LIFE": 0.5, "TABLE": 0.05}  # m; nearer, the depth buffer confuses distant surfaces

_former: dict[str, Any] = {}
_film_scenes: set[int] = set()
"""Scenes, by `session_uid`, that showed the film scene before the session."""


class VrProperties:
    """Properties of the scene that the panel VR shows."""

    vr_scale: bpy.props.EnumProperty(
        name="Scale",
        description="Scale of the scene in the headset",
        items=(
            ("LIFE", "1:1", "Stand in the scene at life size"),
            ("TABLE", "1:1000", "Table top: a kilometre is a metre long"),
        ),
    )
    vr_turn: bpy.props.FloatProperty(
        name="Snap turn",
        description="Angle of a turn with the left thumbstick",
        default=0.5235987755982988,
        min=0.0873,
        max=1.5708,
        subtype="ANGLE",
    )
    vr_fade: bpy.props.BoolProperty(
        name="Fade on cuts", description="Fade from black after a cut to another landmark", default=True
    )
    vr_live: bpy.props.BoolProperty(
        name="Live scene",
        description="Show the live scene in the headset, if there is one; afterwards the 3D views return "
        "to their former scene",
        default=True,
    )
    vr_landmark: bpy.props.StringProperty(name="Landmark", description="Landmark at which the viewer starts")


def is_running() -> bool:
    """Return whether Blender shows a VR session."""
    return bpy.types.XrSessionState.is_running(bpy.context)


def stand(context: bpy.types.Context, name: str) -> bool:
    """Place the viewer at a landmark; False: no such place."""
    scene, manager = context.scene, context.window_manager
    pose = landmark_list.pose(scene, name)
    if pose is None:
        return False
    settings = manager.xr_session_settings
    settings.base_pose_type = "CUSTOM"
    settings.base_pose_location = eyes(scene, pose.place)
    settings.base_pose_angle = pose.angle
    scene.firetwin.vr_landmark = name
    if manager.xr_session_state is not None and is_running():
        manager.xr_session_state.reset_to_base_pose(context)
        if scene.firetwin.vr_fade:
            display.fade()
    return True


def eyes(scene: bpy.types.Scene, place: Vector) -> Vector:
    """Return the place of the eyes of a viewer who has them here at life size.

    At a table top they are half a metre above the table.
    """
    if scene.firetwin.vr_scale == "LIFE":
        return place
    raised = place.copy()
    raised.z += 0.5 * SCALES["TABLE"]
    return raised


def restore() -> None:
    """Give the session settings their former values, and show the film scene if it was shown before."""
    settings = bpy.context.window_manager.xr_session_settings
    for name, value in _former.items():
        setattr(settings, name, value)
    _former.clear()
    for scene in bpy.data.scenes:
        if scene.session_uid in _film_scenes:
            switch.show_live(scene, False)
    _film_scenes.clear()


def _keep(settings: bpy.types.XrSessionSettings) -> None:
    """Note the values that a session changes."""
    for name in _CHANGED:
        value = getattr(settings, name)
        _former.setdefault(name, tuple(value) if name.endswith("location") else value)


def _show_live(scene: bpy.types.Scene) -> None:
    """Show the live scene, if there is one."""
    if scene.firetwin.vr_live and switch.has_live(scene) and not switch.is_live(scene):
        _film_scenes.add(scene.session_uid)
        switch.show_live(scene, True)
        scene.view_layers[0].update()  # the ground under the viewer is another one


def prepare(context: bpy.types.Context) -> None:
    """Set scale, clipping and landmark of the session, and show the live scene."""
    scene, settings = context.scene, context.window_manager.xr_session_settings
    _keep(settings)
    scale = SCALES[scene.firetwin.vr_scale]
    settings.base_scale = scale
    # Blender clips in metres of the room.
    settings.clip_start, settings.clip_end = _NEAR[scene.firetwin.vr_scale], viewport.FAR / scale
    settings.show_floor = False
    _show_live(scene)
    names = landmark_list.names(scene)
    name = scene.firetwin.vr_landmark
    if names:
        stand(context, name if name in names else names[0])


class FIRETWIN_OT_vr_session(bpy.types.Operator):
    """Start Blender's VR session in this scene, or stop it; needs a headset and its OpenXR runtime"""

    bl_idname = "firetwin.vr_session"
    bl_label = "Start or stop VR"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not bpy.app.build_options.xr_openxr:
            cls.poll_message_set("This Blender is built without OpenXR")
            return False
        if bpy.app.background:
            cls.poll_message_set("VR needs Blender's window")
            return False
        return navigation.can_navigate(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        running = is_running()
        if not running:
            prepare(context)
        with context.temp_override(**_view_override(context)):
            bpy.ops.wm.xr_session_toggle()
        if running:
            return {"FINISHED"}
        display.start(restore)
        return {"FINISHED"}


def _view_override(context: bpy.types.Context) -> dict[str, Any]:
    """Return the context of a 3D view, which Blender's operator needs."""
    window = context.window or context.window_manager.windows[0]
    area = next((each for each in window.screen.areas if each.type == "VIEW_3D"), window.screen.areas[0])
    return {"window": window, "area": area}


classes = (FIRETWIN_OT_vr_session,)
