"""Add-on preferences, for all files of this machine."""

from __future__ import annotations

import bpy

from ..shot.settings import Render
from . import keymap, keys

_PACKAGE = __package__.rpartition(".")[0]
AS_FILE = ("scene", "As in the scene", "Device of the scene's settings")
"""Option to use the scene file's value."""


class FIRETWIN_AP_preferences(bpy.types.AddonPreferences):
    """Preferences of this machine"""

    bl_idname = _PACKAGE

    device: keys.create_property(Render, "device", AS_FILE)
    cache: bpy.props.StringProperty(
        name="Cache folder",
        description="Folder of smoke volumes for scenes without a cache folder, such as new ones; empty: "
        "in their output folder. Scenes of a scene file have its cache folder",
        subtype="DIR_PATH",
    )
    cache_limit: bpy.props.FloatProperty(
        name="Cache limit (GB)",
        description="Size of the cache folder above, GB. After each build the volumes that were unused for "
        "longest are removed; 0: no limit",
        default=0.0,
        min=0.0,
        precision=1,
    )
    area_unit: bpy.props.EnumProperty(
        name="Area",
        description="Unit of areas in the panels, once a run is read",
        items=(("acres", "Acres", "US acres"), ("ha", "Hectares", "Hectares")),
    )
    library: bpy.props.StringProperty(options={"HIDDEN"})

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("device", "cache", "cache_limit", "area_unit"):
            layout.prop(self, name)
        keymap.draw(context, layout.box().column())


def get() -> FIRETWIN_AP_preferences | None:
    """Return the preferences; None if the add-on was not enabled there, as in a script."""
    addon = bpy.context.preferences.addons.get(_PACKAGE)
    return None if addon is None else addon.preferences


def device() -> str:
    """Return the Cycles render device for `source.ShotSource`; empty: the scene file's."""
    chosen = AS_FILE[0] if (own := get()) is None else own.device
    return "" if chosen == AS_FILE[0] else chosen


def cache_folder() -> str:
    """Return the cache folder for scenes without one; empty without a preference."""
    return "" if (own := get()) is None else own.cache


def cache_limit() -> int | None:
    """Return the largest size of the cache folder, bytes; None without a limit or a folder."""
    own = get()
    return None if own is None or not own.cache or own.cache_limit <= 0.0 else int(own.cache_limit * 1e9)


def area_unit() -> str:
    """Return the unit of areas: ``acres`` or ``ha``."""
    return "acres" if (own := get()) is None else own.area_unit


classes = (FIRETWIN_AP_preferences,)
