"""Camera list panel in the sidebar, parent of the panels of single cameras."""

from __future__ import annotations

import bpy

from . import build, camera_list, changed_settings, job, sidebar, working
from .sidebar import SidebarPanel


class FIRETWIN_UL_cameras(bpy.types.UIList):
    """Cameras of the scene, by name"""

    bl_idname = "FIRETWIN_UL_cameras"

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.PropertyGroup,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.PropertyGroup,
        active_property: str,
    ) -> None:
        layout.prop(item, "name", text="", emboss=False, icon="CAMERA_DATA")


class FIRETWIN_OT_camera_remove(bpy.types.Operator):
    """Remove the selected camera from the list; rebuilding the cameras removes its objects"""

    bl_idname = "firetwin.camera_remove"
    bl_label = "Remove camera"
    bl_options = {"UNDO", "INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        panel = context.scene.firetwin
        if not 0 <= panel.camera_index < len(panel.cameras):
            cls.poll_message_set("Select a camera in the list first")
            return False
        return working.is_editable(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        panel = context.scene.firetwin
        panel.cameras.remove(panel.camera_index)
        panel.camera_index = max(min(panel.camera_index, len(panel.cameras) - 1), 0)
        changed_settings.compare(panel)
        return {"FINISHED"}


class FIRETWIN_OT_camera_copy(bpy.types.Operator):
    """Duplicate the selected camera"""

    bl_idname = "firetwin.camera_copy"
    bl_label = "Copy camera"
    bl_options = {"UNDO", "INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return FIRETWIN_OT_camera_remove.poll(context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        panel = context.scene.firetwin
        camera = camera_list.get(panel.cameras[panel.camera_index])
        camera_list.add(panel, camera_list.make_unique(panel, camera))
        return {"FINISHED"}


class FIRETWIN_PT_cameras(SidebarPanel, bpy.types.Panel):
    """Cameras of the scene"""

    bl_idname = "FIRETWIN_PT_cameras"
    bl_label = "Cameras"
    bl_options = {"DEFAULT_CLOSED"}
    bl_order = sidebar.CAMERAS

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        SidebarPanel.draw_header_preset(self, context)
        build.draw_rebuild_button(self.layout, "cameras")

    def draw(self, context: bpy.types.Context) -> None:
        panel, row = context.scene.firetwin, self.layout.row()
        row.enabled = job.Job.current is None
        row.template_list(FIRETWIN_UL_cameras.bl_idname, "", panel, "cameras", panel, "camera_index", rows=3)
        column = row.column(align=True)
        column.operator(FIRETWIN_OT_camera_copy.bl_idname, text="", icon="DUPLICATE")
        column.operator(FIRETWIN_OT_camera_remove.bl_idname, text="", icon="REMOVE")
        if not panel.cameras:
            self.layout.label(text="Read run adds cameras", icon="INFO")


classes = (
    FIRETWIN_UL_cameras,
    FIRETWIN_OT_camera_remove,
    FIRETWIN_OT_camera_copy,
    FIRETWIN_PT_cameras,
)
