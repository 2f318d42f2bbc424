"""Render frames and films, exactly as the command line does."""

from __future__ import annotations

from pathlib import Path

import bpy

from . import job, run
from .job import Away, Steps, Working

NO_OUTPUT = "Save the .blend file or choose an output folder first"
_items: list[tuple[str, str, str]] = []  # Blender keeps no reference of its own to these texts


def camera_items(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> list[tuple[str, str, str]]:
    """All cameras, or one that the run's facts name."""
    cameras = run.read(settings.facts)["cameras"] if settings.facts else []
    _items[:] = [
        ("*", "All cameras", "Every camera of the scene"),
        *((name, name, f"The camera {name}") for name in cameras),
    ]
    return _items


class FIRETWIN_OT_render(Working, bpy.types.Operator):
    """Render into the output folder, as the command line does"""

    bl_idname = "firetwin.render"
    bl_label = "Render"
    bl_description = (
        "Render pictures, and films of what is finished, into the output folder, as the command line does: "
        "from the run and the scene file, not from what was changed by hand in this window"
    )
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        settings = context.scene.firetwin
        if settings.run and not run.output(settings):
            cls.poll_message_set(NO_OUTPUT)
            return False
        if settings.run and not settings.passes:
            cls.poll_message_set("Choose at least one pass")
            return False
        return run.ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """All of it in a worker process."""
        from .. import jobs
        from ..wording import count

        settings = context.scene.firetwin
        frames = {"frame": str(context.scene.frame_current), "list": settings.frame_list, "all": ""}
        out = Path(run.output(settings))
        camera = None if settings.camera == "*" else settings.camera
        passes = ",".join(name for name in ("rgb", "depth", "thermal") if name in settings.passes)
        asked = jobs.Asked(out, frames[settings.which], camera, passes, settings.resume)
        chosen = run.choice(settings)
        made = yield Away(
            "starting Blender", lambda progress, stop: jobs.render(chosen, asked, progress, stop=stop)
        )
        return f"Rendered {count(made, 'picture')} to {out}" if made else f"All is finished in {out}"


class FIRETWIN_PT_render(bpy.types.Panel):
    """Pictures and films of the run"""

    bl_idname = "FIRETWIN_PT_render"
    bl_label = "Render"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Firetwin"
    bl_order = 3

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.firetwin
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.enabled = job.Job.current is None
        column.prop(settings, "output")
        column.prop(settings, "engine")
        column.prop(settings, "camera")
        column.prop(settings, "resume")
        for name in ("passes", "which"):
            row = column.row(align=True)
            row.use_property_split = False
            row.prop(settings, name, expand=True)
        if settings.which == "list":
            column.prop(settings, "frame_list")
        row = layout.row(align=True)
        row.scale_y = 1.3
        job.button(row, FIRETWIN_OT_render, "RENDER_STILL")
        out = run.output(settings)
        folder = row.row(align=True)
        folder.enabled = bool(out)
        folder.operator("wm.path_open", text="", icon="FILE_FOLDER").filepath = out
        if not out:
            run.paragraph(context, layout.column(align=True), NO_OUTPUT, "INFO")


classes = (FIRETWIN_OT_render, FIRETWIN_PT_render)
