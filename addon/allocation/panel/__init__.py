"""Operator and panel of a suggested allocation, with the functions of `firetwin allocate`.

Exercise: not operational advice.
"""

from __future__ import annotations

import functools
import json
import math
from pathlib import Path
from typing import Any

import bpy

from ...blender import owned
from ...jobs.worker import Stop
from ...run import times
from ...scene.stations import control_line
from ...shot.shot import Shot
from ...shot.source import ShotSource
from ...ui import run, scene_file, working
from ...ui.job import InThread, Message, Steps
from ...ui.menu_entries import MenuEntry
from ...ui.sidebar import SidebarPanel
from ...ui.text import draw_paragraph
from ...ui.working import Working
from .. import job as allocation_job
from .. import read
from ..problem import Request
from . import text

_FRAME = "frame"
_LABEL = "firetwin_allocation"


class AllocationProperties:
    """Properties of the scene that this panel shows."""

    allocation_from: bpy.props.EnumProperty(
        name="From",
        description="Time of the order",
        items=(
            ("ignition", "Ignition", "Ignition, or the first time of the run if it burns then"),
            (_FRAME, "Current frame", "Time of the current frame"),
        ),
    )
    allocation_hours: bpy.props.IntProperty(
        name="Hours",
        description="Hours after the order; 0: 12, or until the end of the run",
        default=0,
        min=0,
        soft_max=48,
    )
    allocation_divisions: bpy.props.IntProperty(
        name="Divisions",
        description="Number of divisions: sectors around the centre of the burned area",
        default=4,
        min=1,
        max=26,
    )
    allocation_budget: bpy.props.FloatProperty(
        name="Budget", description="Maximum cost of all resources; 0: no limit", default=0.0, min=0.0
    )
    allocation: bpy.props.StringProperty(options={"HIDDEN"})


def _suggest(
    chosen: ShotSource,
    stations: Path,
    frame: int | None,
    asked: dict[str, Any],
    budget: float,
    stop: Stop,
    **_: object,
) -> tuple[Shot, dict[str, Any]]:
    """Read the files and solve in a thread; return the shot and the suggestion."""
    shot = chosen.shot()
    if frame is None:
        order = times.utc(shot.run, allocation_job.default_order_time(shot.run))
    else:
        order = shot.utc(frame)
    units, left_out = read.read(stations, order)
    request = Request(budget or None, escape=math.inf)
    found = allocation_job.suggest(units, shot.run, request, order, stop=stop, **asked)
    found["left_out"] += left_out
    found["zone"] = shot.settings.time.zone
    return shot, found


class FIRETWIN_OT_allocate(Working, bpy.types.Operator):
    """Suggest which resources of the station file to send to which division of the fire's front.

    The control line appears in the 3D view. Exercise: not operational advice
    """

    bl_idname = "firetwin.allocate"
    bl_label = "Suggest allocation of resources"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not run.is_ready(cls, context):
            return False
        if not context.scene.firetwin.stations.file:
            cls.poll_message_set("Choose a station file in the panel Stations first")
            return False
        return working.is_object_mode(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Solve in a worker process, then store the result and draw the control line."""
        scene = context.scene
        uid, panel = scene.session_uid, scene.firetwin
        files = [panel.run, panel.stations.file]
        asked = {"hours": panel.allocation_hours or None, "count": panel.allocation_divisions}
        work = functools.partial(
            _suggest,
            scene_file.shot_source(panel),
            Path(bpy.path.abspath(panel.stations.file)),
            scene.frame_current if panel.allocation_from == _FRAME else None,
            asked,
            panel.allocation_budget,
        )
        shot, result = yield InThread("allocating resources", work)
        yield "drawing the control line"
        features = result.pop("map")["features"]
        scene = owned.scene(uid)
        scene.firetwin.allocation = json.dumps(result | {"files": files})
        if owned.has_data(scene):
            control_line.build(shot, owned.stage(scene), features)
        else:
            yield Message("Build the scene, then suggest again, to see the control line", "WARNING")
        for reason in result["reasons"]:
            yield Message(f"No allocation: {reason}", "WARNING")
        held = sum(each["contained_at_hour"] is not None for each in result["divisions"])
        fronts = sum(any(each["perimeter"]) for each in result["divisions"])
        return f"{held} of {fronts} divisions with fire can be held"


class FIRETWIN_PT_allocation(SidebarPanel, bpy.types.Panel):
    """Suggested allocation of the file's resources to divisions of the front (exercise)"""

    bl_idname = "FIRETWIN_PT_allocation"
    bl_label = "Suggested Allocation"
    bl_parent_id = "FIRETWIN_PT_stations"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, panel = self.layout, context.scene.firetwin
        column = working.settings_column(layout)
        for name in ("allocation_from", "allocation_hours", "allocation_divisions", "allocation_budget"):
            column.prop(panel, name)
        working.draw_button(layout.row(align=True), FIRETWIN_OT_allocate, "COMMUNITY")
        working.draw_messages(context, layout, FIRETWIN_OT_allocate)
        if panel.allocation:
            _draw_result(context, layout, panel)


def _draw_result(
    context: bpy.types.Context, layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup
) -> None:
    """Draw the stored result: a foldable block for each division, and for the resources left out."""
    shown = text.describe(panel.allocation)
    layout.label(text=shown.label, icon="EXPERIMENTAL")
    column = layout.column(align=True)
    if shown.files != (panel.run, panel.stations.file):
        draw_paragraph(context, column, "The run or station file has changed since; suggest again", "ERROR")
    for line in shown.head:
        draw_paragraph(context, column, line)
    for block in shown.blocks:
        header, body = layout.panel(f"{_LABEL}_{block.name}")
        header.label(text=block.title, icon=block.icon)
        if body is not None:
            lines = body.column(align=True)
            for line in block.lines:
                draw_paragraph(context, lines, line)


classes = (FIRETWIN_OT_allocate, FIRETWIN_PT_allocation)
properties = AllocationProperties


def unregister() -> None:
    """Clear the cached text."""
    text.describe.cache_clear()


menu = {"Scene": (MenuEntry("allocate", icon="COMMUNITY"),)}
