"""Setting row in the sidebar: label, value, and a reset button if the value differs from its default."""

from __future__ import annotations

import bpy

from ..shot.schema import Field, fields
from . import keys, sections, working
from .text import labelled_row

_LABEL = 0.48  # fraction of the width
_LETTERS = 17  # characters of a label that fit, in a sidebar of default width


def draw_key(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, part: Field, section: str) -> None:
    """Draw a key on one line, or on two if its value is long."""
    row = layout.row(align=True)
    shown = _draw_value(row, group, part)
    mark = shown.row(align=True)
    if keys.is_changed(group, part):
        mark.operator_context = "EXEC_DEFAULT"
        reset = mark.operator(FIRETWIN_OT_reset.bl_idname, text="", icon="LOOP_BACK", emboss=False)
        reset.section, reset.key = section, part.name
    else:
        mark.label(text="", icon="BLANK1")


def _draw_value(row: bpy.types.UILayout, group: bpy.types.PropertyGroup, part: Field) -> bpy.types.UILayout:
    """Draw the label and the value; return the row for the reset button."""
    text = keys.heading(part)
    if part.type is bool:
        row.prop(group, part.name, text=text)
        return row
    if _needs_full_width(part):
        column = row.column(align=True)
        column.label(text=text)
        line = column.row(align=True)
        if part.key.choices is None:
            line.prop(group, part.name, text="")
        else:
            line.column_flow(columns=2, align=True).prop(group, part.name)
        return line
    line = labelled_row(row, text, _LABEL)
    if keys.has_switch(part):
        line.prop(group, keys.USE + part.name, text="")
        value = line.row(align=True)
        value.active = getattr(group, keys.USE + part.name)
        value.prop(group, part.name, text="")
    else:
        line.prop(group, part.name, text="")
    return line


def _needs_full_width(part: Field) -> bool:
    """Return whether a key needs the sidebar's full width: paths, times, lists, and long labels."""
    if part.type in (int, float):
        return len(keys.heading(part)) > _LETTERS and not keys.has_switch(part)
    return part.type is not str or part.key.choices is None


class FIRETWIN_OT_reset(working.Editable, bpy.types.Operator):
    """Reset this setting, or all settings of a section, to their defaults"""

    bl_idname = "firetwin.reset"
    bl_label = "Reset settings to default"
    bl_options = {"UNDO", "INTERNAL"}

    section: bpy.props.StringProperty(options={"SKIP_SAVE"})
    key: bpy.props.StringProperty(options={"SKIP_SAVE"})

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        section = next(part for part in sections.sections() if part.name == self.section)
        for part in fields(section.table):
            if part.name == self.key or (not self.key and not part.table and not part.key.variants):
                keys.put(getattr(context.scene.firetwin, self.section), part, part.default)
        return {"FINISHED"}


classes = (FIRETWIN_OT_reset,)
