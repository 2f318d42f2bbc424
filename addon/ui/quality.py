"""Quality levels and presets: many settings at once, by three levels or by presets that users save."""

from __future__ import annotations

import functools
from typing import Any

import bpy
from bl_operators.presets import AddPresetBase

from ..shot.schema import Field, fields
from . import job, keys, sections, working

_MOVED = (
    ("terrain", "near_radius"),
    ("terrain", "error"),
    ("tiles", "max_screen_space_error"),
    ("forest", "budget"),
    ("forest", "understorey"),
    ("forest", "draw_distance"),
    ("fire", "firebrands"),
    ("smoke", "method"),
    ("light", "lamps"),
    ("render", "resolution"),
    ("render", "samples"),
)
_STEPS: dict[str, tuple[str, tuple[Any, ...]]] = {
    "preview": (
        "Preview in a minute: coarse terrain, fewer trees, smoke on wide cells, small pictures",
        (1500.0, 1.5, 64.0, 40_000, 5000, 6000.0, 500, "preview", 12, (480, 270), 2),
    ),
    "film": (
        "Films and daily work: solved smoke, pictures of 1280 x 720",
        (4000.0, 0.05, 2.0, 200_000, 40_000, 12_000.0, 3000, "flow", 48, (1280, 720), 6),
    ),
    "final": (
        "Final quality: more trees and shrubs, pictures of 1920 x 1080, little noise. A film takes hours",
        (6000.0, 0.05, 1.0, 400_000, 80_000, 16_000.0, 6000, "flow", 96, (1920, 1080), 24),
    ),
}
LEVELS = {name: dict(zip(_MOVED, values, strict=True)) for name, (_, values) in _STEPS.items()}
"""Settings by section and key, for each quality level."""

_ITEMS = [(name, keys.label(name), words) for name, (words, _) in _STEPS.items()]

_NOT_SAVED = {
    "time": ("start", "end"),
    "terrain": (
        *("elevation", "photo", "photo_extent", "land_use", "buildings"),
        *("photo_url", "photo_layer", "photo_level", "photo_credit"),
    ),
}
"""Settings specific to a run, which presets omit."""


def apply(panel: bpy.types.PropertyGroup, level: str) -> None:
    """Apply all settings of a quality level."""
    for (section, name), value in LEVELS[level].items():
        group, part = _find_group(panel, section, name)
        keys.put(group, part, value)


def current_level(panel: bpy.types.PropertyGroup) -> str:
    """Return the current quality level of the panel; empty: none."""
    for each, values in LEVELS.items():
        if all(keys.is_showing(*_find_group(panel, *place), value) for place, value in values.items()):
            return each
    return ""


def _find_group(
    panel: bpy.types.PropertyGroup, section: str, name: str
) -> tuple[bpy.types.PropertyGroup, Field]:
    return getattr(panel, section), _find_field(section, name)


@functools.cache
def _find_field(section: str, name: str) -> Field:
    kind = next(part.table for part in sections.sections() if part.name == section)
    return next(part for part in fields(kind) if part.name == name)


class FIRETWIN_OT_quality(working.Editable, bpy.types.Operator):
    """Set trees, terrain, smoke, resolution and samples together"""

    bl_idname = "firetwin.quality"
    bl_label = "Set quality"
    bl_options = {"UNDO", "INTERNAL"}

    level: bpy.props.EnumProperty(name="Quality", items=_ITEMS)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        return f"{_STEPS[properties.level][0]}. Rebuild the scene to apply it"

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        apply(context.scene.firetwin, self.level)
        return {"FINISHED"}


class FIRETWIN_OT_preset(working.Editable, AddPresetBase, bpy.types.Operator):
    """Save these settings as a preset, or remove a preset"""

    bl_idname = "firetwin.preset"
    bl_label = "Save settings as preset"
    preset_menu = "FIRETWIN_MT_presets"
    preset_subdir = "firetwin"
    bl_options = {"REGISTER"}
    preset_defines = ["firetwin = bpy.context.scene.firetwin"]

    @property
    def preset_values(self) -> list[str]:
        """Return the values of a preset: every setting that is not specific to a run."""
        saved = ["firetwin.seed"]
        for section in sections.sections():
            names = [
                part.name
                for part in fields(section.table)
                if part.name not in _NOT_SAVED.get(section.name, ())
            ]
            switches = [
                keys.USE + part.name
                for part in fields(section.table)
                if part.name in names and keys.has_switch(part)
            ]
            saved += [f"firetwin.{section.name}.{name}" for name in (*switches, *names)]
        return saved


class FIRETWIN_MT_presets(bpy.types.Menu):
    """Saved presets of settings"""

    bl_idname = "FIRETWIN_MT_presets"
    bl_label = "Presets"
    preset_subdir = "firetwin"
    preset_operator = "script.execute_preset"

    def draw(self, context: bpy.types.Context) -> None:
        if bpy.utils.preset_paths("firetwin"):
            bpy.types.Menu.draw_preset(self, context)
        else:
            self.layout.label(text="No presets are saved: + saves these settings")


def draw(layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup) -> None:
    """Draw the quality levels, with the current one pressed, and the presets."""
    row = layout.row(align=True)
    row.enabled = job.Job.current is None
    here = current_level(panel)
    for name in LEVELS:
        row.operator(FIRETWIN_OT_quality.bl_idname, text=keys.label(name), depress=name == here).level = name
    row = layout.row(align=True)
    row.menu(FIRETWIN_MT_presets.__name__, text=FIRETWIN_MT_presets.bl_label)
    row.operator(FIRETWIN_OT_preset.bl_idname, text="", icon="ADD")
    row.operator(FIRETWIN_OT_preset.bl_idname, text="", icon="REMOVE").remove_active = True


classes = (FIRETWIN_OT_quality, FIRETWIN_OT_preset, FIRETWIN_MT_presets)
