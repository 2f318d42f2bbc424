"""Base class of the panels in the sidebar's tab Firetwin, with a help button in the header."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import manual

if TYPE_CHECKING:
    import bpy

SECTIONS, CAMERAS, SENSORS, RENDER, REPORT = 3, 30, 31, 40, 50
"""Order of the panels after Run, Scene and Time."""


class SidebarPanel:
    """A panel of the tab Firetwin."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Firetwin"

    if TYPE_CHECKING:  # members of bpy.types.Panel
        bl_idname: str
        layout: bpy.types.UILayout

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """Draw the buttons at the right end of the header."""
        manual.draw_button(self.layout, self.bl_idname)
