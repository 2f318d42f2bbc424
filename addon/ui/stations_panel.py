"""Panels of stations: the list with its filters, the selected station, and the map."""

from __future__ import annotations

import bpy

from ..stations.describe import web_map_address
from ..stations.records import EXERCISE
from . import (
    go_to,
    job,
    station_data,
    station_filter,
    station_list,
    station_map,
    station_selection,
    station_sync,
    working,
)
from .sidebar import SidebarPanel
from .text import draw_paragraph, labelled_row


class FIRETWIN_UL_stations(bpy.types.UIList):
    """Stations: name, kind, minutes, and the label of an exercise"""

    bl_idname = "FIRETWIN_UL_stations"

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.PropertyGroup,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.PropertyGroup,
        active_property: str,
    ) -> None:
        line = layout.split(factor=0.5)
        line.label(text=item.name, icon="EXPERIMENTAL" if item.exercise else "HOME")
        line = line.split(factor=0.6)
        line.label(text="Exercise" if item.exercise else item.kind)
        line.label(text=item.minutes)


class FIRETWIN_PT_stations(SidebarPanel, bpy.types.Panel):
    """Stations of the file, with search filters"""

    bl_idname = "FIRETWIN_PT_stations"
    bl_label = "Station List"
    bl_parent_id = "FIRETWIN_PT_section_stations"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        station_sync.wake()
        now, held = station_list.shown(), bpy.context.window_manager.firetwin_stations
        _draw_filters(layout.column(), panel)
        draw_paragraph(context, layout.column(align=True), now.status, "NONE" if now.rows else "INFO")
        if any(row.exercise for row in now.rows):
            layout.label(text=EXERCISE, icon="EXPERIMENTAL")
        if now.loaded is None:
            return
        layout.template_list(FIRETWIN_UL_stations.bl_idname, "", held, "rows", panel, "station_index", rows=6)
        if (found := station_list.detail(panel)) is not None:
            _draw_selected(context, layout.box(), found)


class FIRETWIN_PT_station_map(SidebarPanel, bpy.types.Panel):
    """Map of the listed stations and of the burned ground at the current frame"""

    bl_idname = "FIRETWIN_PT_station_map"
    bl_label = "Station Map"
    bl_parent_id = "FIRETWIN_PT_stations"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.firetwin, "station_map", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        if panel.station_map and station_map.icon():
            layout.template_icon(icon_value=station_map.icon(), scale=12.0)
        row = layout.row(align=True)
        row.operator(station_map.FIRETWIN_OT_station_map.bl_idname, icon="IMAGE_DATA")
        row.operator(station_map.FIRETWIN_OT_station_pick.bl_idname, icon="EYEDROPPER")


def _draw_filters(column: bpy.types.UILayout, panel: bpy.types.PropertyGroup) -> None:
    chosen = panel.station_filter
    column.enabled = job.Job.current is None
    for name in ("kind", "types", "mode", "near"):
        labelled_row(column, chosen.bl_rna.properties[name].name).prop(chosen, name, text="")
    row = column.row(align=True)
    row.active = chosen.near != station_filter.NOWHERE
    row.prop(chosen, "within")
    row.prop(chosen, "minutes")
    column.prop(chosen, "available")


def _draw_selected(context: bpy.types.Context, box: bpy.types.UILayout, detail: station_list.Detail) -> None:
    """Draw the details of the selected station, and links to it."""
    box.label(text=detail.station.name)
    for label, text in detail.lines:
        if label:
            line = box.column(align=True).split(factor=0.3)
            line.label(text=label)
            draw_paragraph(context, line.column(align=True), text)
        else:
            box.label(text=text, icon="EXPERIMENTAL")
    row, at = box.row(align=True), (detail.station.latitude, detail.station.longitude)
    go = row.operator(go_to.FIRETWIN_OT_go.bl_idname, text="Go to place", icon="VIEWZOOM")
    go.text, go.smooth = f"{at[0]:.6f} {at[1]:.6f}", context.scene.firetwin.go_smoothly
    row.operator("wm.url_open", text="Open in web map", icon="URL").url = web_map_address(*at)


def sync() -> bool:
    """Update list and map; return True while files are still being read."""
    window = bpy.context.window or next(iter(bpy.context.window_manager.windows), None)
    scene = bpy.context.scene if window is None else window.scene
    before = station_list.shown().stamp
    reading = station_list.refresh(scene.firetwin)
    station_map.update(scene)
    if station_list.shown().stamp != before:
        working.redraw()
    return reading


def register() -> None:
    """Store the rows in the window manager, and follow time, undo and the 3D view."""
    bpy.types.WindowManager.firetwin_stations = bpy.props.PointerProperty(
        type=station_list.FIRETWIN_PG_stations, options={"SKIP_SAVE"}
    )
    station_selection.register()
    station_sync.start(sync)


def unregister() -> None:
    """Undo `register`."""
    station_sync.stop()
    station_selection.unregister()
    station_map.clear()
    station_list.clear()
    station_data.clear()
    del bpy.types.WindowManager.firetwin_stations


classes = (
    *station_list.classes,
    *station_map.classes,
    FIRETWIN_UL_stations,
    FIRETWIN_PT_stations,
    FIRETWIN_PT_station_map,
)
