"""Walk or fly through the scene, with a key that sets camera keys on the way."""

from __future__ import annotations

import bpy

from . import keymap, navigation, working

_FLIGHTS = ("VIEW3D_OT_walk", "VIEW3D_OT_fly")


class FIRETWIN_OT_fly(bpy.types.Operator):
    """Walk or fly with Blender's keys. The key of Set camera key, K, keys the scene's camera on the way"""

    bl_idname = "firetwin.fly"
    bl_label = "Walk or fly with camera keys"
    bl_options = {"REGISTER", "UNDO"}

    mode: bpy.props.EnumProperty(
        name="Mode",
        description="Way of moving through the view",
        items=(
            ("walk", "Walk", "Walk with W, A, S, D and the pointer"),
            ("fly", "Fly", "Fly with the pointer and the wheel"),
        ),
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return navigation.can_navigate(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        context.scene.firetwin  # noqa: B018
        self.report({"WARNING"}, "Walk and fly need the window of Blender")
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        start = {"walk": bpy.ops.view3d.walk, "fly": bpy.ops.view3d.fly}[self.mode]
        if "RUNNING_MODAL" not in start("INVOKE_DEFAULT"):
            return {"CANCELLED"}
        context.window_manager.modal_handler_add(self)  # handled before the flight
        self.report({"INFO"}, f"{keymap.key_of('firetwin.camera_key') or 'No key'} sets a camera key")
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not any(each.bl_idname in _FLIGHTS for each in context.window.modal_operators):
            return {"FINISHED", "PASS_THROUGH"}
        if event.value == "PRESS" and event.type == keymap.key_of("firetwin.camera_key"):
            self._set_key(context)
            return {"RUNNING_MODAL"}
        return {"PASS_THROUGH"}

    def _set_key(self, context: bpy.types.Context) -> None:
        """Key the camera, or report why it cannot be keyed."""
        try:
            bpy.ops.firetwin.camera_key()
        except RuntimeError as error:
            self.report({"WARNING"}, str(error).strip())
        else:
            self.report({"INFO"}, f"Keyed {context.scene.camera.name} at frame {context.scene.frame_current}")


classes = (FIRETWIN_OT_fly,)
