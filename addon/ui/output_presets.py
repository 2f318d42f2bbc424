"""Output presets in the panel Render: settings of EXR files and films for a kind of post-production."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..errors import Error
from ..shot import schema
from ..shot.settings import Render, output_presets
from . import camera_list, job, keys, scene_file, working
from .text import labelled_row

_ITEMS = [(name, keys.label(name), each.help) for name, each in output_presets.PRESETS.items()]


class FIRETWIN_OT_output_preset(working.Editable, bpy.types.Operator):
    """Set passes, EXR files and films for a kind of post-production"""

    bl_idname = "firetwin.output_preset"
    bl_label = "Set output preset"
    bl_options = {"UNDO", "INTERNAL"}

    preset: bpy.props.EnumProperty(name="Output preset", items=_ITEMS)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        return output_presets.PRESETS[properties.preset].help

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        apply(context.scene, self.preset)
        return {"FINISHED"}


def apply(scene: bpy.types.Scene, name: str) -> None:
    """Apply a preset to the panel of a scene; only settings that it changes are set.

    Raises
    ------
    Error
        A setting is invalid, or the scene cannot be rendered with the preset.
    """
    panel = scene.firetwin
    before = scene_file.read_settings(scene, Path(panel.scene_file or bpy.data.filepath or "scene.toml"))
    after = output_presets.apply(before, name)
    if mistake := schema.validate(after):
        raise Error(keys.sentence(mistake[1]))
    for part in schema.fields(Render):
        value = getattr(after.render, part.name)
        if value != getattr(before.render, part.name):
            keys.put(panel.render, part, value)
    for item, old, new in zip(panel.cameras, before.cameras, after.cameras, strict=True):
        if new != old:
            camera_list.put(item, new)


def draw(layout: bpy.types.UILayout) -> None:
    """Draw a button for each preset."""
    row = labelled_row(layout, "Preset")
    row.enabled = job.Job.current is None
    for name in output_presets.PRESETS:
        row.operator(FIRETWIN_OT_output_preset.bl_idname, text=keys.label(name)).preset = name


classes = (FIRETWIN_OT_output_preset,)
