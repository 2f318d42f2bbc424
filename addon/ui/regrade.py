"""Operator that grades a film of the pass `comp` in the compositor."""

from __future__ import annotations

from pathlib import Path

import bpy
from bpy_extras.io_utils import ImportHelper

from . import working


class FIRETWIN_OT_regrade(working.Editable, bpy.types.Operator, ImportHelper):
    """Grade flames, smoke, lights and haze of a film of the pass comp in the compositor of this scene"""

    bl_idname = "firetwin.regrade"
    bl_label = "Add Firetwin Regrade"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".exr"
    filter_glob: bpy.props.StringProperty(default="*.exr", options={"HIDDEN"})

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        from ..render import regrade_nodes

        node = regrade_nodes.add(context.scene, Path(bpy.path.abspath(self.filepath)))
        self.report({"INFO"}, f"The compositor has the node {node.name}")
        return {"FINISHED"}


classes = (FIRETWIN_OT_regrade,)
