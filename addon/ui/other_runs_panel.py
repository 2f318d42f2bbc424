"""Panel of comparison runs in the sidebar."""

from __future__ import annotations

import bpy

from ..shot.settings import MOST_RUNS
from . import job, working
from .sidebar import SidebarPanel
from .text import draw_paragraph


class FIRETWIN_OT_run_add(bpy.types.Operator):
    """Add another run of the same place and time, filmed by the same cameras"""

    bl_idname = "firetwin.run_add"
    bl_label = "Add run to compare"
    bl_options = {"UNDO", "INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if len(context.scene.firetwin.runs) >= MOST_RUNS:
            cls.poll_message_set(f"At most {MOST_RUNS} other runs")
            return False
        return working.is_editable(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        panel = context.scene.firetwin
        taken = {item.name for item in panel.runs}
        names = ("what-if", *(f"what-if-{number}" for number in range(2, MOST_RUNS + 1)))
        name = next(name for name in names if name not in taken)
        panel.runs.add().name = name
        return {"FINISHED"}


class FIRETWIN_OT_run_remove(working.Editable, bpy.types.Operator):
    """Remove this run from the list"""

    bl_idname = "firetwin.run_remove"
    bl_label = "Remove run"
    bl_options = {"UNDO", "INTERNAL"}

    index: bpy.props.IntProperty(options={"SKIP_SAVE"})

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        context.scene.firetwin.runs.remove(self.index)
        return {"FINISHED"}


class FIRETWIN_PT_other_runs(SidebarPanel, bpy.types.Panel):
    """Other runs of the same place and time, for comparison"""

    bl_idname = "FIRETWIN_PT_other_runs"
    bl_label = "Compare With"
    bl_parent_id = "FIRETWIN_PT_run"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        panel, column = context.scene.firetwin, self.layout.column()
        column.enabled = job.Job.current is None
        for index, item in enumerate(panel.runs):
            row = column.row(align=True)
            row.prop(item, "name", text="")
            row.prop(item, "path", text="")
            row.operator(FIRETWIN_OT_run_remove.bl_idname, text="", icon="REMOVE").index = index
        column.operator(FIRETWIN_OT_run_add.bl_idname, icon="ADD")
        if panel.runs:
            text = "The passes split and difference compare runs. Fronts, under Fire, draws their fronts"
            draw_paragraph(context, column.column(align=True), text, "INFO")


classes = (FIRETWIN_OT_run_add, FIRETWIN_OT_run_remove, FIRETWIN_PT_other_runs)
