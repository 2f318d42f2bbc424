"""Choose a run or a scene file, and see what is in it."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

import bpy

from ..blender import owned
from ..shot import file
from ..shot.choice import Choice
from . import by_hand, camera_list, job, preferences, scene_file, working
from .job import Away, Steps
from .text import labelled, paragraph
from .working import Working


def chosen(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Another run folder: look into it."""
    if job.Job.current is not None:
        return
    settings.facts = settings.problem = ""
    if settings.run:
        _inspect(settings)
    working.redraw()


def imported(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Another scene file: fill the panel from it."""
    if job.Job.current is not None or not settings.scene_file:
        return
    try:
        scene_file.fill(settings.id_data, file.read(bpy.path.abspath(settings.scene_file)))
    except Exception as error:
        settings.facts, settings.problem = "", job.words(error)
    working.redraw()


def _inspect(settings: bpy.types.PropertyGroup) -> None:
    """Call the operator; what it has to say about a failure is in `problem`, so no error is raised here."""
    try:
        with bpy.context.temp_override(scene=settings.id_data):
            bpy.ops.firetwin.inspect("INVOKE_DEFAULT")
    except RuntimeError as error:
        settings.problem = settings.problem or str(error)


def choice(settings: bpy.types.PropertyGroup) -> Choice:
    """What the panel and the preferences choose, with what was done to cameras by hand."""
    by_hand.pull(settings.id_data)
    return Choice(str(scene_file.written(settings.id_data)), device=preferences.device())


def ready(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether there is a run and nothing else goes on; says what is missing."""
    settings = context.scene.firetwin
    if not settings.run:
        cls.poll_message_set("Open a run or a scene file first")
        return False
    if not settings.cache and not scene_file.output(settings):
        cls.poll_message_set("Save the .blend file or choose an output folder first: the smoke is kept there")
        return False
    return working.free(cls)


class FIRETWIN_OT_inspect(Working, bpy.types.Operator):
    """Look into the run again: grids, extent, times, burned area, warnings"""

    bl_idname = "firetwin.inspect"
    bl_label = "Read run"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not context.scene.firetwin.run:
            cls.poll_message_set("Open a run or a scene file first")
            return False
        return working.free(cls)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Gather in a thread; then write down, and see whether the settings fit the run."""
        uid, settings = context.scene.session_uid, context.scene.firetwin
        settings.problem = settings.facts = ""
        folder, zone = Path(bpy.path.abspath(settings.run)), settings.time.zone
        try:
            found = yield Away("reading the run", lambda **_: facts(folder, zone))
            _write_down(owned.scene(uid).firetwin, found)
            chosen = choice(owned.scene(uid).firetwin)
            yield Away("reading the run", lambda **_: chosen.shot())
        except Exception as error:
            owned.scene(uid).firetwin.problem = job.words(error)
            raise
        return f"Read {found['name']}"


def _write_down(settings: bpy.types.PropertyGroup, found: dict[str, Any]) -> None:
    """Keep the facts; cameras that nobody chose go, and those for this run come."""
    here = camera_list.text(camera_list.cameras(settings))
    settings.facts = json.dumps(found)
    if here in ("", settings.usual_cameras) and here != found["cameras"]:
        camera_list.fill(settings, camera_list.listed(found["cameras"]))
        settings.usual_cameras = found["cameras"]


def facts(folder: Path, zone: str) -> dict[str, Any]:
    """What the panel shows of a run: name, rows of label and text, warnings, dated moments; its cameras."""
    from ..run import info, readers
    from ..shot import overview

    run = readers.open(folder)
    found = info.gather(run, zone)
    return {
        "name": found["name"],
        "synthetic": found["synthetic"],
        "rows": info.brief(found),
        "warnings": found["warnings"],
        "first": found["times"]["first"],
        "last": found["times"]["last"],
        "reported": found["reported"],
        "cameras": camera_list.text(overview.cameras(run)),
    }


@functools.lru_cache(maxsize=8)
def read(text: str) -> dict[str, Any]:
    """`facts` from the text that the .blend file keeps."""
    return json.loads(text)


class FIRETWIN_PT_run(bpy.types.Panel):
    """The model run that the scene shows"""

    bl_idname = "FIRETWIN_PT_run"
    bl_label = "Run"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Firetwin"
    bl_order = 0

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.firetwin, self.layout
        column = layout.column()
        column.enabled = job.Job.current is None
        row = labelled(column, "Run")
        row.prop(settings, "run", text="")
        row.operator(FIRETWIN_OT_inspect.bl_idname, text="", icon="FILE_REFRESH")
        row = labelled(column, "Scene file")
        row.prop(settings, "scene_file", text="", placeholder="Optional")
        if settings.problem:
            box = layout.box().column(align=True)
            paragraph(context, box, settings.problem, "ERROR")


class FIRETWIN_PT_facts(bpy.types.Panel):
    """Grids, extent, times, burned area and warnings of the run"""

    bl_idname = "FIRETWIN_PT_facts"
    bl_label = "What It Holds"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Firetwin"
    bl_parent_id = "FIRETWIN_PT_run"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(context.scene.firetwin.facts)

    def draw(self, context: bpy.types.Context) -> None:
        found = read(context.scene.firetwin.facts)
        column = self.layout.column(align=True)
        paragraph(context, column, found["name"])
        for label, text in found["rows"]:
            labelled(column, label).label(text=text)
        for warning in found["warnings"]:
            paragraph(context, column, warning, "ERROR")


classes = (FIRETWIN_OT_inspect, FIRETWIN_PT_run, FIRETWIN_PT_facts)
