"""The scene that the panel and the preferences choose."""

from __future__ import annotations

import bpy

from ..shot.source import ShotSource
from . import camera_edits, preferences, scene_file


def from_panel(settings: bpy.types.PropertyGroup) -> ShotSource:
    """What the panel and the preferences choose, with what was done to cameras by hand."""
    camera_edits.pull(settings.id_data)
    return ShotSource(str(scene_file.written(settings.id_data)), device=preferences.device())
