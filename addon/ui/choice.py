"""Shot source from the panel and the preferences."""

from __future__ import annotations

import bpy

from ..shot.source import ShotSource
from . import camera_edits, preferences, scene_file


def from_panel(settings: bpy.types.PropertyGroup) -> ShotSource:
    """Return the shot source of the panel and the preferences, with manual edits of cameras."""
    camera_edits.read_camera_edits(settings.id_data)
    return ShotSource(str(scene_file.write_temporary(settings.id_data)), device=preferences.device())
