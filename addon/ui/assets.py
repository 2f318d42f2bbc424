"""Asset library operator: writes the library of the run's shot."""

from __future__ import annotations

import functools
from pathlib import Path

import bpy

from ..errors import Error
from ..progress import count
from . import asset_library, render, run, scene_file
from .job import InThread, Steps
from .working import Working


class FIRETWIN_OT_assets(Working, bpy.types.Operator):
    """Write an asset library of trees, materials and node groups for the asset browser"""

    bl_idname = "firetwin.assets"
    bl_label = "Write asset library"
    bl_options = {"REGISTER"}

    directory: bpy.props.StringProperty(
        name="Folder", description="Folder of the library; empty: in the output folder", subtype="DIR_PATH"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return run.is_ready(cls, context)

    def steps(self, context: bpy.types.Context) -> Steps:
        """Run the job in a worker process."""
        from ..jobs import assets

        settings = context.scene.firetwin
        out = bpy.path.abspath(self.directory) or scene_file.output_folder(settings, "assets")
        if not out:
            raise Error(render.NO_OUTPUT)
        made = yield InThread(
            "starting Blender", functools.partial(assets.run, scene_file.shot_source(settings), Path(out))
        )
        asset_library.add(Path(out))
        return f"Wrote {count(made, 'asset')} to {out}; the asset browser lists them as {asset_library.NAME}"


classes = (FIRETWIN_OT_assets,)
