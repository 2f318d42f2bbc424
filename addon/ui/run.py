"""Run panel: select a run or a scene file, and inspect it."""

from __future__ import annotations

import functools
import json
from datetime import datetime
from pathlib import Path
from typing import Any

import bpy

from ..blender import owned, stored_json
from ..jobs.worker import StoppedError
from ..run import readers
from ..shot.settings import scene_file as file
from . import auto_framing, changed_settings, job, maps, preferences, scene_file, solve, working
from .job import InThread, Steps
from .sidebar import SidebarPanel
from .text import draw_paragraph, labelled_row
from .working import Working

_FACTS: dict[str, stored_json.Shape] = {
    "name": str,
    "rows": [(str, str)],
    "warnings": [str],
    "first": str,
    "last": str,
    "zone": str,
    "moments": [(datetime, str)],
    "burned": [(str, str, str)],
    "places": [(str, float, float, str)],
}
"""Facts of a run that panels show."""


def on_run_changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Inspect another run folder (update callback)."""
    changed_settings.compare(settings)
    if job.Job.current is not None:
        return
    settings.facts = settings.problem = ""
    if settings.run:
        _inspect(settings)
    working.redraw()


def on_scene_file_changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Fill the panel from another scene file (update callback)."""
    if job.Job.current is not None or not settings.scene_file:
        return
    try:
        scene_file.fill(settings.id_data, file.read(bpy.path.abspath(settings.scene_file)))
    except Exception as error:
        settings.problem = job.describe_error(error)
    working.redraw()


def _inspect(settings: bpy.types.PropertyGroup) -> None:
    """Inspect a run, or convert a model's files; errors go into `problem` and are not raised."""
    folder = Path(bpy.path.abspath(settings.run))
    try:
        with bpy.context.temp_override(scene=settings.id_data):
            if readers.foreign(folder):
                bpy.ops.firetwin.convert("INVOKE_DEFAULT", filepath=str(folder))
            else:
                bpy.ops.firetwin.inspect("INVOKE_DEFAULT")
    except RuntimeError as error:
        settings.problem = settings.problem or str(error)


def is_ready(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether there is a run and no task is running; otherwise set the poll message."""
    settings = context.scene.firetwin
    if not settings.run:
        cls.poll_message_set("Open a run or a scene file first")
        return False
    return working.is_editable(cls, context)


class FIRETWIN_OT_inspect(Working, bpy.types.Operator):
    """Read the run again: grids, extent, times, burned area, warnings"""

    bl_idname = "firetwin.inspect"
    bl_label = "Read run"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return is_ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Inspect the run, and check whether the settings fit it."""
        return (yield from inspect_run(context.scene.session_uid))


def inspect_run(uid: int) -> Steps:
    """Inspect in a thread, then store the facts in the scene with this `session_uid`."""
    from . import feature_panels  # whose panels import this module

    settings = owned.scene(uid).firetwin
    settings.problem = ""
    folder = Path(bpy.path.abspath(settings.run))
    try:
        after, (facts, images) = yield InThread(
            "reading the run", lambda **_: (feature_panels.look(folder), collect_facts(folder))
        )
        owned.scene(uid).firetwin.facts = json.dumps(facts)
        for start in after:
            start()
        auto_framing.apply_framing(owned.scene(uid).firetwin, facts["fits"])
        maps.show(owned.scene(uid).firetwin.run, images)
        yield from auto_framing.reframe(uid)
        chosen = scene_file.shot_source(owned.scene(uid).firetwin)
        yield InThread("reading the run", lambda **_: chosen.shot())
        yield from solve.estimate_cost(uid)
    except StoppedError:
        owned.scene(uid).firetwin.problem = "The run was only partly read; use Read run"
        raise
    except Exception as error:
        owned.scene(uid).firetwin.problem = job.describe_error(error)
        raise
    return f"Read {facts['name']}"


def collect_facts(folder: Path) -> tuple[dict[str, Any], maps.Images]:
    """Collect facts of a run for the panel: name, rows, warnings, dated events, framing; and its maps."""
    from ..run import info, labels, thumbnails, zone
    from ..stations import events

    run = readers.open(folder)
    report, unit = info.gather(run, zone.time_zone(run)), preferences.area_unit()
    told = {
        "name": report["name"],
        "synthetic": report["synthetic"],
        "rows": info.brief(report, unit),
        "warnings": report["warnings"],
        "first": report["times"]["first"],
        "last": report["times"]["last"],
        "zone": report["zone"],
        "moments": events.reports(report, unit),
        "burned": _burned_areas(report, unit),
        "places": labels.known(run),
        "fits": auto_framing.frame_run(run),
    }
    return told, thumbnails.draw(run)


def _burned_areas(facts: dict[str, Any], unit: str) -> list[tuple[str, str, str]]:
    """Return burned areas: date, reported area, and the run's area with its difference."""
    from ..run import info, times

    return [
        (
            times.text(datetime.fromisoformat(each["time"]), facts["zone"]),
            f"{info.format_area(each['reported'], unit)} {unit}",
            f"{info.format_area(each['run'], unit)} {unit} ({round(each['difference'], 3) + 0.0:+.1%})",
        )
        for each in facts["reported"]
        if each["run"] is not None
    ]


@functools.lru_cache(maxsize=8)
def parse_facts(text: str) -> dict[str, Any]:
    """Parse the facts stored as text in the .blend file."""
    return stored_json.record(text, _FACTS)


class FIRETWIN_PT_run(SidebarPanel, bpy.types.Panel):
    """Run that the scene shows"""

    bl_idname = "FIRETWIN_PT_run"
    bl_label = "Run"
    bl_order = 0

    def draw(self, context: bpy.types.Context) -> None:
        from . import feature_panels

        settings, layout = context.scene.firetwin, self.layout
        column = layout.column()
        column.enabled = job.Job.current is None
        if not settings.run:
            _draw_hint(context, column)
        row = labelled_row(column, "Run", 0.2)
        row.prop(settings, "run", text="")
        row.operator(FIRETWIN_OT_inspect.bl_idname, text="", icon="FILE_REFRESH")
        row = labelled_row(column, "File", 0.2)
        row.prop(settings, "scene_file", text="", placeholder="Scene file, if any")
        row.operator("firetwin.export", text="", icon="EXPORT")
        if settings.problem:
            box = layout.box().column(align=True)
            draw_paragraph(context, box, settings.problem, "ERROR")
            working.draw_copy_button(box, settings.problem)
        feature_panels.draw_run(context, column, Path(bpy.path.abspath(settings.run)))
        maps.draw(layout, settings.run)


def _draw_hint(context: bpy.types.Context, layout: bpy.types.UILayout) -> None:
    """Draw a hint for the first step."""
    draw_paragraph(context, layout.column(align=True), "Open a run, or try the synthetic King Fire.", "INFO")
    row = layout.column(align=True)
    row.operator("firetwin.open", text="Open run...", icon="FILEBROWSER")
    row.operator("firetwin.sample", icon="LIGHT_SUN")


class FIRETWIN_PT_facts(SidebarPanel, bpy.types.Panel):
    """Grids, extent, times, burned area and warnings of the run"""

    bl_idname = "FIRETWIN_PT_facts"
    bl_label = "Content of the Run"
    bl_parent_id = "FIRETWIN_PT_run"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(context.scene.firetwin.facts)

    def draw(self, context: bpy.types.Context) -> None:
        facts = parse_facts(context.scene.firetwin.facts)
        column = self.layout.column(align=True)
        draw_paragraph(context, column, facts["name"])
        for label, text in facts["rows"]:
            labelled_row(column, label).label(text=text)
        for warning in facts["warnings"]:
            draw_paragraph(context, column, warning, "ERROR")
        for line in auto_framing.framing_messages(context.scene.firetwin):
            draw_paragraph(context, column, f"{line[:1].upper()}{line[1:]}")


classes = (FIRETWIN_OT_inspect, FIRETWIN_PT_run, FIRETWIN_PT_facts)
