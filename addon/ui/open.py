"""Open operators: open a run or a scene file, drop it on the view, or create the sample run."""

from __future__ import annotations

import functools
from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ..blender import owned
from ..run import readers
from . import build, foreign, run, scene_file, working
from .job import InThread, Steps
from .working import Working

_RUN = "run.toml"
_FILES = "*.toml;*.nc;*.npz;*.asc;*.tif;*.tiff;*.bil;*.lcp;*.prj;*.geojson;*.kml;*.csv;*.ff;wrfout*"


class FIRETWIN_OT_open(working.Editable, foreign.ImportOptions, bpy.types.Operator, ImportHelper):
    """Open a run (its run.toml or its folder), a scene file, or a fire model's files"""

    bl_idname = "firetwin.open"
    bl_label = "Open run"
    bl_description = (
        "Open a run (its run.toml or its folder), a scene file, or all files of a fire model's run. "
        "A fire model's files are converted to a run next to them. Opening another run resets the time "
        "window and cameras; the field Run does not"
    )
    bl_options = {"UNDO"}

    filename_ext = ".toml"
    filter_glob: bpy.props.StringProperty(default=_FILES, options={"HIDDEN"})
    directory: bpy.props.StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    files: bpy.props.CollectionProperty(
        type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"}
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.filepath and Path(self.filepath).is_file():  # dropped on the view
            return self.execute(context)
        return ImportHelper.invoke(self, context, event)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        panel, path = context.scene.firetwin, Path(self.filepath)
        if readers.foreign(foreign.selected_files(self)[0]):
            return self._convert(panel)
        if path.suffix == ".toml" and path.name != _RUN and not path.is_dir():
            panel.scene_file = str(path)
        else:
            foreign.select_run(panel, str(path.parent if path.name == _RUN else path))
        if panel.problem:
            self.report({"ERROR"}, panel.problem)
        return {"FINISHED"}

    def _convert(self, panel: bpy.types.PropertyGroup) -> set[str]:
        """Convert a fire model's files to a run."""
        words = {name: getattr(self, name) for name in ("filepath", "directory", "start", "at", "projection")}
        files = [{"name": file.name} for file in self.files]
        try:
            return bpy.ops.firetwin.convert("INVOKE_DEFAULT", files=files, **words)
        except RuntimeError as error:
            self.report({"ERROR"}, panel.problem or str(error))
            return {"CANCELLED"}


class FIRETWIN_OT_export(bpy.types.Operator, ExportHelper):
    """Write the settings and cameras of this panel as a scene file for `firetwin render`"""

    bl_idname = "firetwin.export"
    bl_label = "Export scene file"

    filename_ext = ".toml"
    filter_glob: bpy.props.StringProperty(default="*.toml", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return run.is_ready(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        scene_file.export(context.scene, Path(self.filepath))
        self.report({"INFO"}, f"Wrote {self.filepath}")
        return {"FINISHED"}


class FIRETWIN_FH_open(bpy.types.FileHandler):
    """A run.toml, a scene file or a fire model's files dropped on a 3D view

    GeoTIFF, which Blender also handles, and wrfout files, which have no file extension, are opened from the
    menu.
    """

    bl_idname = "FIRETWIN_FH_open"
    bl_label = "Fire model run"
    bl_import_operator = FIRETWIN_OT_open.bl_idname
    bl_file_extensions = ".toml;.nc;.npz;.asc"

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        """Return whether the pointer is over a 3D view."""
        return context.area is not None and context.area.type == "VIEW_3D"


class FIRETWIN_OT_sample(working.Editable, Working, bpy.types.Operator):
    """Write the sample run, a synthetic King Fire, to this computer and open it; nothing is downloaded"""

    bl_idname = "firetwin.sample"
    bl_label = "Try the King Fire"
    bl_options = {"UNDO"}

    folder: bpy.props.StringProperty(
        name="Folder",
        description="Output folder of the run; empty: Firetwin's folder",
        subtype="DIR_PATH",
        options={"SKIP_SAVE"},
    )

    def steps(self, context: bpy.types.Context) -> Steps:
        """Write the run in a worker process, unless it exists; then inspect it."""
        from ..jobs import sample

        uid = context.scene.session_uid
        folder = Path(bpy.path.abspath(self.folder)) if self.folder else scene_file.own_folder() / "king_fire"
        yield InThread("writing the sample run", functools.partial(sample.run, folder))
        foreign.select_run(owned.scene(uid).firetwin, str(folder))
        return (yield from run.inspect_run(uid))


class FIRETWIN_MT_add(bpy.types.Menu):
    """Add the fire of a model run"""

    bl_idname = "FIRETWIN_MT_add"
    bl_label = "Firetwin"

    def draw(self, context: bpy.types.Context) -> None:
        draw_entries(self.layout)
        self.layout.operator(build.FIRETWIN_OT_build.bl_idname, icon="WORLD")
        self.layout.operator("firetwin.assets", icon="ASSET_MANAGER")


def draw_entries(layout: bpy.types.UILayout) -> None:
    """Draw menu entries that open a run."""
    layout.operator_context = "INVOKE_DEFAULT"
    layout.operator(FIRETWIN_OT_open.bl_idname, text="Open run...", icon="FILEBROWSER")
    layout.operator(FIRETWIN_OT_sample.bl_idname, icon="LIGHT_SUN")


def _import(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(FIRETWIN_OT_open.bl_idname, text="Fire model run (.toml, .nc, .tif, ...)")


def _export(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(FIRETWIN_OT_export.bl_idname, text="Firetwin scene file (.toml)")


def _add(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.menu(FIRETWIN_MT_add.bl_idname, icon="WORLD")


_MENUS = (("TOPBAR_MT_file_import", _import), ("TOPBAR_MT_file_export", _export), ("VIEW3D_MT_add", _add))


def register() -> None:
    """Add the entries to Blender's menus."""
    for name, draw in _MENUS:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Remove the entries from Blender's menus."""
    for name, draw in _MENUS:
        getattr(bpy.types, name).remove(draw)


classes = (
    FIRETWIN_OT_open,
    FIRETWIN_OT_export,
    FIRETWIN_FH_open,
    FIRETWIN_OT_sample,
    FIRETWIN_MT_add,
)
