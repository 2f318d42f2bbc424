"""Keyboard shortcuts in the 3D view; users change them in the preferences of the add-on or of Blender."""

from __future__ import annotations

from typing import Any

import bpy

_KEYMAP = "3D View"
SHORTCUTS: tuple[tuple[str, str, str, dict[str, bool]], ...] = (
    ("firetwin.camera_key", "", "K", {"ctrl": True, "alt": True}),
    ("firetwin.fly", "", "W", {"ctrl": True, "alt": True}),
    ("wm.call_menu_pie", "FIRETWIN_MT_pie", "F", {"ctrl": True, "alt": True}),
)
"""Operator, menu (if the operator calls one), key and modifiers."""

_added: list[tuple[Any, Any]] = []
_created: list[Any] = []
"""The key map, if no other add-on had made it before."""


def register() -> None:
    """Add the shortcuts to the add-on's key configuration."""
    config = bpy.context.window_manager.keyconfigs.addon
    if config is None:  # Blender in the background
        return
    keymap = config.keymaps.find(_KEYMAP, space_type="VIEW_3D")
    if keymap is None:
        keymap = config.keymaps.new(name=_KEYMAP, space_type="VIEW_3D")
        _created.append(keymap)
    for operator, menu, key, modifiers in SHORTCUTS:
        item = keymap.keymap_items.new(operator, key, "PRESS", **modifiers)
        if menu:
            item.properties.name = menu
        _added.append((keymap, item))


def unregister() -> None:
    """Remove the shortcuts, and their key map unless another add-on had or has keys in it."""
    while _added:
        keymap, item = _added.pop()
        keymap.keymap_items.remove(item)
    while _created:
        keymap = _created.pop()
        if not keymap.keymap_items:
            bpy.context.window_manager.keyconfigs.addon.keymaps.remove(keymap)


def users_items() -> list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]]:
    """Return the shortcuts as the user has set them, in the order of `SHORTCUTS`."""
    config = bpy.context.window_manager.keyconfigs.user
    keymap = config.keymaps.get(_KEYMAP) if config is not None else None
    if keymap is None:
        return []
    items = []
    for operator, menu, *_ in SHORTCUTS:
        for item in keymap.keymap_items:
            if item.idname == operator and (not menu or item.properties.name == menu):
                items.append((keymap, item))
                break
    return items


def key_of(operator: str) -> str:
    """Return the user's key of an operator, without modifiers, such as ``K``; empty without one."""
    items = (item for _, item in users_items() if item.idname == operator and item.active)
    return next((item.type for item in items), "")


def draw(context: bpy.types.Context, layout: bpy.types.UILayout) -> None:
    """Draw the shortcuts as Blender's keymap editor does."""
    import rna_keymap_ui

    for keymap, item in users_items():
        layout.context_pointer_set("keymap", keymap)
        rna_keymap_ui.draw_kmi([], context.window_manager.keyconfigs.user, keymap, item, layout, 0)
