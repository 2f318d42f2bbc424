"""Report panel: facts of the run and messages of the last task."""

from __future__ import annotations

import bpy

from . import keys, run, sidebar, working
from .job import Job
from .sidebar import SidebarPanel
from .text import draw_paragraph, labelled_row


class FIRETWIN_PT_report(SidebarPanel, bpy.types.Panel):
    """Burned area of the run and as reported, and messages of the last task"""

    bl_idname = "FIRETWIN_PT_report"
    bl_label = "Report"
    bl_options = {"DEFAULT_CLOSED"}
    bl_order = sidebar.REPORT

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.firetwin
        if not settings.facts:
            layout.label(text="Open a run first", icon="INFO")
        for time, reported, area in run.parse_facts(settings.facts)["burned"]:
            column = layout.column(align=True)
            column.label(text=time)
            labelled_row(column, "Reported", 0.4).label(text=reported)
            labelled_row(column, "Run", 0.4).label(text=area)
        if Job.last is not None:
            column = layout.box().column(align=True)
            lines = [message.text for message in Job.last.messages]
            for line in lines:
                draw_paragraph(context, column, keys.sentence(line))
            working.draw_copy_button(column, "\n".join((Job.last.name, *lines)))


classes = (FIRETWIN_PT_report,)
