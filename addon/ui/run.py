"""Choose a run and a scene file, and see what is in them."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

import bpy

from . import job
from .job import Away, Steps, Working


def chosen(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Another run folder: look into it."""
    settings.facts = settings.problem = ""
    if settings.run and job.Job.current is None:
        _inspect(settings)
    job.redraw()


def scene_file_chosen(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Another scene file: it says which run, which is looked into at once."""
    settings.problem = ""
    if not settings.scene_file:
        return
    from .. import project

    try:
        settings.run = str(project.load(absolute(settings.scene_file)).run)
    except Exception as error:
        settings.problem = job.words(error)
        job.redraw()


def _inspect(settings: bpy.types.PropertyGroup) -> None:
    """Call the operator; what it has to say about a failure is in `problem`, so no error is raised here."""
    try:
        bpy.ops.firetwin.inspect("INVOKE_DEFAULT")
    except RuntimeError as error:
        settings.problem = settings.problem or str(error)


def absolute(path: str) -> str:
    """A path of the panel as one for the system."""
    return bpy.path.abspath(path) if path else ""


def output(settings: bpy.types.PropertyGroup) -> str:
    """The output folder; empty while it hangs on a .blend file that is not saved."""
    if settings.output.startswith("//") and not bpy.data.filepath:
        return ""
    return absolute(settings.output)


def choice(settings: bpy.types.PropertyGroup) -> Any:
    """What the panel chooses, as `choice.Choice`."""
    from ..choice import Choice

    scene_file, folder = absolute(settings.scene_file), output(settings)
    cache = str(Path(folder) / "cache") if folder and not scene_file else ""
    engine = "" if settings.engine == "scene" else settings.engine
    return Choice(scene_file, absolute(settings.run), cache, engine)


def ready(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether there is a run and nothing else goes on; says what is missing."""
    settings = context.scene.firetwin
    if not settings.run:
        cls.poll_message_set("Choose a run folder or a scene file first")
        return False
    if not settings.scene_file and not output(settings):
        cls.poll_message_set("Save the .blend file or choose an output folder first: the smoke is kept there")
        return False
    return job.free(cls)


class FIRETWIN_OT_inspect(Working, bpy.types.Operator):
    """Look into the run again: grids, extent, times, burned area, warnings"""

    bl_idname = "firetwin.inspect"
    bl_label = "Read run"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not context.scene.firetwin.run:
            cls.poll_message_set("Choose a run folder first")
            return False
        return job.free(cls)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Gather in a thread; then write down."""
        settings = context.scene.firetwin
        settings.problem = settings.facts = ""
        chosen = choice(settings)
        try:
            found = yield Away("reading the run", lambda progress, stop: facts(chosen))
        except Exception as error:
            settings.problem = job.words(error)
            raise
        settings.facts = json.dumps(found)
        return f"Read {found['name']}"


def facts(chosen: Any) -> dict[str, Any]:
    """What the panel shows of a choice: name, rows of label and text, warnings and cameras."""
    from firetwin_core import run as runs

    from .. import info

    project = chosen.project()
    found = info.gather(runs.open(project.run), project.time.zone)
    cameras = [camera.name for camera in project.cameras] if chosen.scene else ["overview", "satellite"]
    return {
        "name": found["name"],
        "synthetic": found["synthetic"],
        "rows": info.brief(found),
        "warnings": found["warnings"],
        "cameras": cameras,
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


def labelled(layout: bpy.types.UILayout, label: str) -> bpy.types.UILayout:
    """A row after a label that takes less room than Blender's own."""
    line = layout.split(factor=0.3)
    line.label(text=label)
    return line.row(align=True)


def paragraph(context: bpy.types.Context, layout: bpy.types.UILayout, text: str, icon: str = "NONE") -> None:
    """Text on as many lines as the sidebar's width asks for."""
    import textwrap

    scale = context.preferences.system.ui_scale
    letters = max(int((context.region.width / scale - 60) / 6.5), 16)
    for number, line in enumerate(textwrap.wrap(text, letters)):
        layout.label(text=line, icon=icon if number == 0 else ("BLANK1" if icon != "NONE" else "NONE"))


classes = (FIRETWIN_OT_inspect, FIRETWIN_PT_run, FIRETWIN_PT_facts)
