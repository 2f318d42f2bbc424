"""Import of a fire model's files: a worker process converts them to a run, which is then opened."""

from __future__ import annotations

import functools
import re
from pathlib import Path

import bpy

from ..blender import owned
from . import job, run, scene_file, working
from .job import InThread, Steps
from .working import Working


class ImportOptions:
    """Import options for information that files may not contain, as properties of an operator."""

    start: bpy.props.StringProperty(
        name="Start",
        description="Start time of a fire model's files that do not give it, such as 2014-09-17T04:45:00Z",
        options={"SKIP_SAVE"},
    )
    at: bpy.props.StringProperty(
        name="At",
        description="Latitude and longitude of the centre of a fire model's grid without projection, such as "
        "38.78,-120.6",
        options={"SKIP_SAVE"},
    )
    projection: bpy.props.StringProperty(
        name="Projection",
        description="Projection of a fire model's files that do not name it, such as EPSG:5070",
        options={"SKIP_SAVE"},
    )


class FIRETWIN_OT_convert(working.Editable, ImportOptions, Working, bpy.types.Operator):
    """Convert a fire model's files to a run, next to them or in the output folder, and open the run"""

    bl_idname = "firetwin.convert"
    bl_label = "Convert model output"
    bl_options = {"UNDO"}

    filepath: bpy.props.StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE"})
    directory: bpy.props.StringProperty(subtype="DIR_PATH", options={"SKIP_SAVE"})
    files: bpy.props.CollectionProperty(type=bpy.types.OperatorFileListElement, options={"SKIP_SAVE"})

    def steps(self, context: bpy.types.Context) -> Steps:
        """Convert in a worker process, unless the run already exists; then inspect the run."""
        from ..jobs import convert

        uid, paths = context.scene.session_uid, selected_files(self)
        panel = context.scene.firetwin
        panel.problem = ""
        try:
            output = scene_file.output_folder(panel)
            folders = [paths[0].parent, *([Path(output)] if output else []), scene_file.own_folder() / "runs"]
            said = {name: getattr(self, name).strip() for name in ("start", "at", "projection")}
            out, there = convert.default_output(paths, folders, **said)
            if not there:
                yield InThread(
                    "reading the model's files", functools.partial(convert.run, paths, out, **said)
                )
        except Exception as error:
            owned.scene(uid).firetwin.problem = _reword_error(error)
            raise
        select_run(owned.scene(uid).firetwin, str(out))
        return (yield from run.inspect_run(uid))


def _reword_error(error: Exception) -> str:
    """Rewrite an error text with the operator's fields in place of command-line options."""
    option = r"--(start|at|projection)\b"
    return re.sub(
        option,
        lambda found: f"{found[1].capitalize()} (next to the files in Open run)",
        job.describe_error(error),
    )


def selected_files(operator: bpy.types.Operator) -> list[Path]:
    """Return the selected files, file or folder."""
    names = [file.name for file in operator.files if file.name]
    if names and operator.directory:
        return [Path(operator.directory, name) for name in names]
    return [Path(bpy.path.abspath(operator.filepath or operator.directory))]


def select_run(panel: bpy.types.PropertyGroup, folder: str) -> None:
    """Select a run; time window and cameras of another run are reset."""
    if bpy.path.abspath(panel.run) != folder:
        panel.scene_file = panel.time.start = panel.time.end = panel.facts = panel.smoke_cost = ""
        panel.cameras.clear()
    panel.run = folder


classes = (FIRETWIN_OT_convert,)
