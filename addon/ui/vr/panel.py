"""Panel VR: starts and stops the session, and shows landmarks, scale, comfort and frame time."""

from __future__ import annotations

import bpy

from ...scene.live import switch
from .. import panel_state, working
from ..sidebar import SidebarPanel
from ..text import draw_paragraph
from . import display, landmark_list, session


class FIRETWIN_MT_vr_landmarks(bpy.types.Menu):
    """Landmark at which the viewer starts, or to which a running session cuts"""

    bl_idname = "FIRETWIN_MT_vr_landmarks"
    bl_label = "Start VR at"

    def draw(self, context: bpy.types.Context) -> None:
        for name in landmark_list.names(context.scene):
            self.layout.operator("firetwin.vr_start_at", text=name).name = name


class FIRETWIN_OT_vr_start_at(bpy.types.Operator):
    """Start VR at this landmark; a running session cuts to it"""

    bl_idname = "firetwin.vr_start_at"
    bl_label = "Start VR at landmark"
    bl_options = {"INTERNAL"}

    name: bpy.props.StringProperty(name="Name", description="Name of the landmark")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return panel_state.is_built(context.scene)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        if self.name not in landmark_list.names(context.scene):
            self.report({"WARNING"}, f'No landmark "{self.name}" in this scene')
            return {"CANCELLED"}
        context.scene.firetwin.vr_landmark = self.name
        if session.is_running():
            session.stand(context, self.name)
        return {"FINISHED"}


class FIRETWIN_PT_vr(SidebarPanel, bpy.types.Panel):
    """The scene in a headset, by Blender's VR session"""

    bl_idname = "FIRETWIN_PT_vr"
    bl_label = "VR"
    bl_parent_id = "FIRETWIN_PT_cameras"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return panel_state.is_built(context.scene)

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        layout.use_property_split = True
        layout.use_property_decorate = False
        running = session.is_running()
        column = layout.column()
        text = "Stop VR" if running else "Start VR"
        column.operator("firetwin.vr_session", text=text, icon="CANCEL" if running else "VIEW3D")
        column.menu(FIRETWIN_MT_vr_landmarks.bl_idname, text=panel.vr_landmark or "Landmark", icon="PMARKER")
        fixed = layout.column()
        fixed.enabled = not running
        fixed.prop(panel, "vr_scale")
        fixed.prop(panel, "vr_live")
        layout.prop(panel, "vr_turn")
        layout.prop(panel, "vr_fade")
        if running:
            words, slow = display.describe(display.frame_time())
            layout.label(text=words, icon="ERROR" if slow else "NONE")
            if slow:
                text = display.remedy(switch.is_live(context.scene), context.space_data.shading.type)
                draw_paragraph(context, layout.column(align=True), text)
        layout.operator("firetwin.vr_landmarks", icon="PMARKER_ACT")


classes = (FIRETWIN_OT_vr_start_at, FIRETWIN_MT_vr_landmarks, FIRETWIN_PT_vr)
