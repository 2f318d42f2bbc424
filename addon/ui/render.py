"""Render operator: pictures and films, as the command line renders them."""

from __future__ import annotations

import functools
from pathlib import Path

import bpy

from ..progress import count
from . import output_presets, run, scene_file, sidebar, working
from .job import InThread, Steps
from .sidebar import SidebarPanel
from .text import draw_paragraph
from .working import Working

NO_OUTPUT = "Save the .blend file or choose an output folder first"
_items: list[tuple[str, str, str]] = []  # Blender does not hold a reference to these texts


def camera_items(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> list[tuple[str, str, str]]:
    """Return enumeration items: all cameras, or one of the list."""
    _items[:] = [
        ("*", "All cameras", "Every camera of the scene"),
        *((item.name, item.name, f"The camera {item.name}") for item in settings.cameras),
    ]
    return _items


class FIRETWIN_OT_render(Working, bpy.types.Operator):
    """Render into the output folder, as `firetwin render` does"""

    bl_idname = "firetwin.render"
    bl_label = "Render"
    bl_description = (
        "Render pictures and films into the output folder, as the command line does. Run and settings of the "
        "panel are used; manual changes to the scene are not"
    )
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        settings = context.scene.firetwin
        if settings.run and not scene_file.output_folder(settings):
            cls.poll_message_set(NO_OUTPUT)
            return False
        return run.is_ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Run the job in a worker process."""
        from ..jobs import render

        settings = context.scene.firetwin
        frames = {"frame": str(context.scene.frame_current), "list": settings.frame_list, "all": None}
        out = Path(scene_file.output_folder(settings))
        camera = None if settings.camera == "*" else settings.camera
        asked = render.RenderRequest(out, frames[settings.which], camera, resume=settings.resume)
        chosen = scene_file.shot_source(settings)
        made = yield InThread("starting Blender", functools.partial(render.run, chosen, asked))
        if not made.pictures:
            return f"All pictures in {out} are finished"
        return f"Rendered {count(made.pictures, 'picture')} to {out}"


class FIRETWIN_PT_render(SidebarPanel, bpy.types.Panel):
    """Pictures and films of the run"""

    bl_idname = "FIRETWIN_PT_render"
    bl_label = "Render"
    bl_options = {"DEFAULT_CLOSED"}
    bl_order = sidebar.RENDER

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.firetwin
        column = working.settings_column(layout)
        column.prop(settings, "output")
        column.prop(settings, "cache", placeholder="In the output")
        column.prop(settings, "camera")
        column.prop(settings, "resume")
        output_presets.draw(column)
        row = column.row(align=True)
        row.use_property_split = False
        row.prop(settings, "which", expand=True)
        if settings.which == "list":
            column.prop(settings, "frame_list")
        row = layout.row(align=True)
        row.scale_y = 1.3
        working.draw_button(row, FIRETWIN_OT_render, "RENDER_STILL")
        out = scene_file.output_folder(settings)
        folder = row.row(align=True)
        folder.enabled = bool(out)
        folder.operator("wm.path_open", text="", icon="FILE_FOLDER").filepath = out
        if not out:
            draw_paragraph(context, layout.column(align=True), NO_OUTPUT, "INFO")
        working.draw_messages(context, layout, FIRETWIN_OT_render)


classes = (*output_presets.classes, FIRETWIN_OT_render, FIRETWIN_PT_render)
