"""Background render queue: operators, panel, and Esc over the panel."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..blender import owned
from . import panel_state, queue, render, run, scene_file, working
from .sidebar import SidebarPanel
from .text import draw_paragraph

_ICONS = {
    queue.WAITING: "TIME",
    queue.RENDERING: "RENDER_ANIMATION",
    queue.PAUSED: "PAUSE",
    queue.DONE: "CHECKMARK",
    queue.FAILED: "ERROR",
}


class FIRETWIN_OT_render_background(bpy.types.Operator):
    """Render a copy of this file in the background, including manual changes.

    Later changes do not affect it. Renders are queued and run one after the other
    """

    bl_idname = "firetwin.render_background"
    bl_label = "Render in background"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not panel_state.require(cls, context):
            return False
        if not scene_file.output_folder(context.scene.firetwin):
            cls.poll_message_set(render.NO_OUTPUT)
            return False
        return run.is_ready(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        from ..jobs import render_blend
        from ..jobs.render import RenderRequest

        scene, settings = context.scene, context.scene.firetwin
        frames = {"frame": str(scene.frame_current), "list": settings.frame_list, "all": None}
        camera = None if settings.camera == "*" else settings.camera
        asked = RenderRequest(Path(scene_file.output_folder(settings)), frames[settings.which], camera)
        which = {
            "frame": f"frame {scene.frame_current}",
            "list": f"frames {settings.frame_list}",
            "all": "all",
        }
        title = f"{camera or 'All cameras'}, {which[settings.which]}"
        try:
            queue.add(title, scene, scene_file.shot_source(settings), asked, render_blend.run)
        except (RuntimeError, OSError) as error:
            self.report({"ERROR"}, f"The file cannot be copied: {' '.join(str(error).split())}")
            return {"CANCELLED"}
        queue.advance()
        if not bpy.app.background and not FIRETWIN_OT_queue_esc.on:
            bpy.ops.firetwin.queue_esc("INVOKE_DEFAULT")
        return {"FINISHED"}


class FIRETWIN_OT_f12_files(bpy.types.Operator):
    """Make F12 and Ctrl-F12 write pictures (PNG, EXR) into the output folder, with Firetwin's file names.

    Depth, normal and thermal passes need several renders: use Render in background
    """

    bl_idname = "firetwin.f12_files"
    bl_label = "F12 writes files"
    bl_options = {"REGISTER", "UNDO"}

    on: bpy.props.BoolProperty(name="On", description="Write the files; off: stop writing them", default=True)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not owned.is_ours(context.scene) or not panel_state.is_built(context.scene):
            cls.poll_message_set("Build the scene with Firetwin first")
            return False
        return working.is_editable(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        from ..render import native_render as shown

        scene, settings = context.scene, context.scene.firetwin
        stage, out = owned.stage(scene), scene_file.output_folder(settings)
        names = [item.name for item in settings.cameras if stage.camera(item.name) == scene.camera]
        if not self.on:
            shown.to_none(stage)
        elif not out or not names:
            self.report({"WARNING"}, render.NO_OUTPUT if names else "The scene's camera is not in the list")
            return {"CANCELLED"}
        else:
            shown.to_files(stage, Path(out), names[0], tuple(settings.render.passes))
            self.report({"INFO"}, f"F12 and Ctrl-F12 write into {Path(out) / names[0]}")
        return {"FINISHED"}


class FIRETWIN_OT_queue_esc(bpy.types.Operator):
    """Pause the background render when Esc is pressed over this sidebar"""

    bl_idname = "firetwin.queue_esc"
    bl_label = "Esc pauses the queue"
    bl_options = {"INTERNAL"}

    on = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return not cls.on

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        type(self).on = True
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        busy = queue.current()
        if busy is None and not any(item.state == queue.WAITING for item in queue.items):
            type(self).on = False
            return {"FINISHED", "PASS_THROUGH"}
        pressed = event.type == "ESC" and event.value == "PRESS"
        if pressed and busy is not None and working.is_over_sidebar(context.window, event):
            queue.pause(busy)
            return {"RUNNING_MODAL"}
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Handle the opening of another file."""
        type(self).on = False


class FIRETWIN_OT_queue(bpy.types.Operator):
    """Pause, resume or remove a render"""

    bl_idname = "firetwin.queue"
    bl_label = "Pause, resume or remove a render"
    bl_options = {"INTERNAL"}

    index: bpy.props.IntProperty(options={"SKIP_SAVE"})
    what: bpy.props.EnumProperty(
        items=(
            ("pause", "Pause", "Pause the render; finished pictures remain"),
            ("go_on", "Resume", "Render the missing pictures"),
            ("remove", "Remove", "Remove the render from the queue; its pictures remain"),
        ),
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        items = properties.bl_rna.properties["what"].enum_items
        return items[properties.what].description

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not queue.items:
            cls.poll_message_set("Nothing renders in the background")
        return bool(queue.items)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        if not 0 <= self.index < len(queue.items):
            return {"CANCELLED"}
        item = queue.items[self.index]
        {"pause": queue.pause, "go_on": queue.go_on, "remove": queue.remove}[self.what](item)
        queue.start_timer()
        return {"FINISHED"}


class FIRETWIN_PT_queue(SidebarPanel, bpy.types.Panel):
    """Queue of background renders"""

    bl_idname = "FIRETWIN_PT_queue"
    bl_label = "Background Renders"
    bl_parent_id = "FIRETWIN_PT_render"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        from ..render import native_render as shown

        layout.operator(FIRETWIN_OT_render_background.bl_idname, icon="RENDER_ANIMATION")
        built = owned.is_ours(context.scene) and panel_state.is_built(context.scene)
        on = built and shown.has_outputs(context.scene)
        row = layout.row()
        row.operator(FIRETWIN_OT_f12_files.bl_idname, icon="OUTPUT", depress=on).on = not on
        for index, item in enumerate(queue.items):
            box = layout.box().column(align=True)
            row = box.row(align=True)
            row.label(text=item.title, icon=_ICONS[item.state])
            if item.state in (queue.RENDERING, queue.WAITING):
                self.button(row, index, "pause", "PAUSE")
            elif item.state in (queue.PAUSED, queue.FAILED):
                self.button(row, index, "go_on", "PLAY")
            self.button(row, index, "remove", "X")
            if item.state == queue.RENDERING:
                box.progress(factor=item.factor, text=item.text)
            else:
                draw_paragraph(context, box, item.text)
            icons = queue.thumbnails(item)
            if icons:
                grid = box.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
                for _name, icon in icons:
                    grid.template_icon(icon, scale=4.0)

    def button(self, row: bpy.types.UILayout, index: int, what: str, icon: str) -> None:
        """Draw a button for one render of the queue."""
        pressed = row.operator(FIRETWIN_OT_queue.bl_idname, text="", icon=icon)
        pressed.index, pressed.what = index, what


classes = (
    FIRETWIN_OT_render_background,
    FIRETWIN_OT_f12_files,
    FIRETWIN_OT_queue_esc,
    FIRETWIN_OT_queue,
    FIRETWIN_PT_queue,
)
