"""Export operator and panel: writes the scene for other programs, as `firetwin export` does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import bpy

from ..errors import Error, InputError, input_error
from ..progress import count
from ..ui import render, run, scene_file, working
from ..ui.job import InThread, Steps
from ..ui.menu_entries import MenuEntry
from ..ui.sidebar import SidebarPanel
from ..ui.working import Working
from . import formats
from . import job as export_job
from .request import ExportRequest

_ITEMS = tuple((name, each.title, each.help) for name, each in formats.known().items())


class ExportProperties:
    """Properties of the scene that this panel shows."""

    export_to: bpy.props.EnumProperty(name="Format", description="Format of the export", items=_ITEMS)
    export_frames: bpy.props.StringProperty(
        name="Frames", description="Exported frames, such as 1-10 or 1-48:4; empty: all"
    )
    export_smoke: bpy.props.BoolProperty(
        name="Smoke", description="Write the smoke volumes, in formats with volumes", default=True
    )
    export_overwrite: bpy.props.BoolProperty(
        name="Overwrite", description="Also replace files that changed or that Firetwin did not write"
    )


class FIRETWIN_OT_export_to(Working, bpy.types.Operator):
    """Write the scene for other programs, in a folder of the output folder"""

    bl_idname = "firetwin.export_to"
    bl_label = "Export for other programs"
    bl_options = {"REGISTER"}

    to: bpy.props.StringProperty(
        name="Format", description="Name of the format; empty: the format of the panel", options={"SKIP_SAVE"}
    )
    directory: bpy.props.StringProperty(
        name="Folder", description="Folder to write; empty: in the output folder", subtype="DIR_PATH"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return run.is_ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Run the job in a thread; formats that need the built scene start a worker process."""
        panel = context.scene.firetwin
        name = self.to or panel.export_to
        out = bpy.path.abspath(self.directory) or scene_file.output_folder(panel, f"export_{name}")
        if not out:
            raise Error(render.NO_OUTPUT)
        request = ExportRequest(
            scene_file.shot_source(panel),
            name,
            Path(out),
            panel.export_frames,
            smoke=panel.export_smoke,
            overwrite=panel.export_overwrite,
        )
        try:
            paths = yield InThread(
                "exporting", lambda **callbacks: export_job.run(replace(request, **callbacks))
            )
        except InputError as error:
            reason = error.reason.replace("add --overwrite", "set Overwrite")
            raise input_error(error.path, reason, kind=type(error)) from error
        return f"Wrote {count(len(paths), 'file')} to {out}"


class FIRETWIN_PT_export(SidebarPanel, bpy.types.Panel):
    """Export of the scene to USD, glTF, GIS, Google Earth and Cesium"""

    bl_idname = "FIRETWIN_PT_export"
    bl_label = "Export"
    bl_parent_id = "FIRETWIN_PT_render"
    bl_order = 2
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        column = working.settings_column(layout)
        column.prop(panel, "export_to")
        column.prop(panel, "export_frames")
        if formats.known()[panel.export_to].has_smoke:
            column.prop(panel, "export_smoke")
        column.prop(panel, "export_overwrite")
        working.draw_button(layout.row(align=True), FIRETWIN_OT_export_to, "EXPORT")
        working.draw_messages(context, layout, FIRETWIN_OT_export_to)


def _draw_menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    for name, title, _ in _ITEMS:
        pressed = self.layout.operator(FIRETWIN_OT_export_to.bl_idname, text=f"Firetwin: {title}")
        pressed.to = name


def register() -> None:
    """Add the entries to Blender's menu."""
    bpy.types.TOPBAR_MT_file_export.append(_draw_menu)


def unregister() -> None:
    """Remove the entries from Blender's menu."""
    bpy.types.TOPBAR_MT_file_export.remove(_draw_menu)


classes = (FIRETWIN_OT_export_to, FIRETWIN_PT_export)
properties = ExportProperties
menu = {"Render": (MenuEntry("export_to", icon="EXPORT"),)}
