"""Section panels of the sidebar, generated from the settings' schema: one for each section."""

from __future__ import annotations

from typing import Any

import bpy

from ..scene.build import PARTS
from ..shot.schema import Field, fields
from . import build, job, keys, rows, sections, sidebar
from .sidebar import SidebarPanel

_OWN = ("time",)  # drawn by a separate panel
_BELOW = {"render": "FIRETWIN_PT_render"}  # sections inside another panel
_LATE = ("thermal",)  # after the cameras


def draw(layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup, name: str) -> None:
    """Draw every key of a section; keys that differ from their default have a reset button."""
    section = next(part for part in sections.sections() if part.name == name)
    group = getattr(panel, name)
    column = layout.column(align=False)
    column.enabled = job.Job.current is None
    for part in fields(section.table):
        if not part.table and not part.key.variants:
            rows.draw_key(column, group, part, name)


def _create_panel(section: Field, place: int) -> type[bpy.types.Panel]:
    """Create the panel class of a section, with a rebuild button if its part can be built separately."""
    name = section.name

    def drawn(self: bpy.types.Panel, context: bpy.types.Context) -> None:
        draw(self.layout, context.scene.firetwin, name)

    def again(self: bpy.types.Panel, context: bpy.types.Context) -> None:
        SidebarPanel.draw_header_preset(self, context)
        build.draw_rebuild_button(self.layout, name, name in context.scene.firetwin.changed.split())

    own: dict[str, Any] = {
        "__doc__": keys.sentence(section.key.help),
        "bl_idname": f"FIRETWIN_PT_section_{name}",
        "bl_label": "Render Settings" if name in _BELOW else keys.section_title(name),
        "bl_options": {"DEFAULT_CLOSED"},
        "bl_order": place,
        "draw": drawn,
    }
    if name in PARTS:
        own["draw_header_preset"] = again
    if name in _BELOW:
        own["bl_parent_id"] = _BELOW[name]
    return type(own["bl_idname"], (SidebarPanel, bpy.types.Panel), own)


def _create_panels() -> tuple[type[bpy.types.Panel], ...]:
    shown = [part for part in sections.sections() if part.name not in _OWN]
    late = (*_LATE, *_BELOW)
    early = [part for part in shown if part.name not in late]
    return (
        *(_create_panel(part, sidebar.SECTIONS + place) for place, part in enumerate(early)),
        *(
            _create_panel(part, sidebar.SENSORS + place)
            for place, part in enumerate(p for p in shown if p not in early)
        ),
    )


classes = _create_panels()
