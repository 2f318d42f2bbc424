"""Choose a run and a scene file, and see what is in them."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

import bpy

from ..blender import owned
from ..shot.choice import Choice
from . import job, preferences, working
from .job import Away, Steps
from .text import labelled, paragraph
from .working import Working


def chosen(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Another run folder or scene file: look into it."""
    if job.Job.current is not None:
        return
    settings.facts = settings.problem = ""
    if source(settings):
        _inspect(settings)
    working.redraw()


def _inspect(settings: bpy.types.PropertyGroup) -> None:
    """Call the operator; what it has to say about a failure is in `problem`, so no error is raised here."""
    try:
        with bpy.context.temp_override(scene=settings.id_data):
            bpy.ops.firetwin.inspect("INVOKE_DEFAULT")
    except RuntimeError as error:
        settings.problem = settings.problem or str(error)


def source(settings: bpy.types.PropertyGroup) -> str:
    """The scene file, else the run folder that is chosen."""
    return settings.scene_file or settings.run


def shown_run(settings: bpy.types.PropertyGroup) -> str:
    """The run of the scene file, once that is read."""
    return read(settings.facts)["run"] if settings.scene_file and settings.facts else ""


def absolute(path: str) -> str:
    """A path of the panel as one for the system."""
    return bpy.path.abspath(path) if path else ""


def output(settings: bpy.types.PropertyGroup) -> str:
    """The output folder; empty while it hangs on a .blend file that is not saved."""
    if settings.output.startswith("//") and not bpy.data.filepath:
        return ""
    return absolute(settings.output)


def choice(settings: bpy.types.PropertyGroup) -> Choice:
    """What the panel and the preferences choose; a scene file's run and cache are its own."""
    scene_file, folder = absolute(settings.scene_file), output(settings)
    own = {
        name: "" if chosen == preferences.AS_FILE[0] else chosen
        for name, chosen in (("engine", settings.engine), ("smoke", settings.method))
    }
    if scene_file:
        return Choice(scene_file, device=preferences.device(), **own)
    cache = str(Path(folder) / "cache") if folder else ""
    return Choice(run=absolute(settings.run), cache=cache, device=preferences.device(), **own)


def ready(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether there is a run and nothing else goes on; says what is missing."""
    settings = context.scene.firetwin
    if not source(settings):
        cls.poll_message_set("Choose a run folder or a scene file first")
        return False
    if not settings.scene_file and not output(settings):
        cls.poll_message_set("Save the .blend file or choose an output folder first: the smoke is kept there")
        return False
    return working.free(cls)


class FIRETWIN_OT_inspect(Working, bpy.types.Operator):
    """Look into scene file and run again: grids, extent, times, burned area, warnings"""

    bl_idname = "firetwin.inspect"
    bl_label = "Read run"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not source(context.scene.firetwin):
            cls.poll_message_set("Choose a run folder or a scene file first")
            return False
        return working.free(cls)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Gather in a thread; then write down."""
        uid, settings = context.scene.session_uid, context.scene.firetwin
        settings.problem = settings.facts = ""
        chosen = choice(settings)
        try:
            found = yield Away("reading the run", lambda **_: facts(chosen))
        except Exception as error:
            owned.scene(uid).firetwin.problem = job.words(error)
            raise
        owned.scene(uid).firetwin.facts = json.dumps(found)
        return f"Read {found['name']}"


def facts(chosen: Choice) -> dict[str, Any]:
    """What the panel shows of a choice: name, folder, rows of label and text, warnings and cameras."""
    from ..run import info

    shot = chosen.shot()
    found = info.gather(shot.run, shot.settings.time.zone)
    return {
        "name": found["name"],
        "run": str(shot.settings.run),
        "synthetic": found["synthetic"],
        "rows": info.brief(found),
        "warnings": found["warnings"],
        "cameras": [camera.name for camera in shot.settings.cameras],
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
        row = labelled(column, "Scene file")
        row.prop(settings, "scene_file", text="", placeholder="Optional")
        row = labelled(column, "Run")
        if settings.scene_file:
            line = row.row(align=True)
            line.enabled = False
            line.prop(settings, "shown_run", text="")
        else:
            row.prop(settings, "run", text="")
        row.operator(FIRETWIN_OT_inspect.bl_idname, text="", icon="FILE_REFRESH")
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
