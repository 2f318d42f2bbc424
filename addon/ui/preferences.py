"""Add-on preferences, for all files of this machine."""

from __future__ import annotations

import bpy

from ..shot.settings import Render
from . import keys

_PACKAGE = __package__.rpartition(".")[0]
AS_FILE = ("scene", "As in the scene", "Device of the scene's settings")
"""Option to use the scene file's value."""


class FIRETWIN_AP_preferences(bpy.types.AddonPreferences):
    """Preferences of this machine"""

    bl_idname = _PACKAGE

    device: keys.create_property(Render, "device", AS_FILE)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "device")


def device() -> str:
    """Return the Cycles render device for `source.ShotSource`; empty: the scene file's."""
    addon = bpy.context.preferences.addons.get(_PACKAGE)
    chosen = addon.preferences.device if addon is not None and addon.preferences is not None else AS_FILE[0]
    return "" if chosen == AS_FILE[0] else chosen


classes = (FIRETWIN_AP_preferences,)
