"""Registrations in a running Blender and files in a folder, recorded before and after, and compared."""

from __future__ import annotations

import sys
import threading
from pathlib import Path

import bpy

_OWNERS = (
    "Scene",
    "Object",
    "WindowManager",
    "Screen",
    "Window",
    "Collection",
    "World",
    "Camera",
    "Preferences",
)


def take(folder: Path) -> dict[str, list[str]]:
    """Everything that an add-on can leave behind, by kind, as sorted texts; files are below `folder`."""
    inventory = {
        "classes": [name for name in dir(bpy.types) if isinstance(getattr(bpy.types, name, None), type)],
        "properties": [f"{owner}.{name}" for owner in _OWNERS for name in _properties(owner)],
        "handlers": list(_handlers()),
        "operators": [f"{group}.{name}" for group in dir(bpy.ops) for name in _operators(group)],
        "drawn in menus": list(_drawn()),
        "shortcuts": list(_shortcuts()),
        "threads": [thread.name for thread in threading.enumerate()],
        # Without the folder itself: its name may be anything, and Blender's own place for wheels is in it.
        "search path": [path.removeprefix(str(folder)) for path in sys.path],
        "enabled": [addon.module for addon in bpy.context.preferences.addons],
        "files": [str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()],
    }
    return {kind: sorted(names) for kind, names in inventory.items()}


def _properties(owner: str) -> list[str]:
    # Python adds names such as __annotations_cache__ when something reads a class's annotations.
    return [name for name in dir(getattr(bpy.types, owner)) if not name.startswith("__")]


def _operators(group: str) -> list[str]:
    # Blender makes groups on demand; only ours is known by name.
    return dir(getattr(bpy.ops, group)) if group == "firetwin" else []


def _handlers() -> list[str]:
    for kind in dir(bpy.app.handlers):
        functions = getattr(bpy.app.handlers, kind)
        if isinstance(functions, list):
            for function in functions:
                yield f"{kind}: {function.__module__}.{function.__qualname__}"


def _drawn() -> list[str]:
    for name in dir(bpy.types):
        functions = getattr(getattr(getattr(bpy.types, name), "draw", None), "_draw_funcs", [])
        for function in functions:
            if function.__module__.startswith("bl_ui"):  # Blender's own, first in a list once one is added
                continue
            yield f"{name}: {function.__module__}.{getattr(function, '__qualname__', '?')}"


def _shortcuts() -> list[str]:
    for keymap in bpy.context.window_manager.keyconfigs.addon.keymaps:
        for item in keymap.keymap_items:
            yield f"{keymap.name}: {item.idname}"


def left(before: dict[str, list[str]], after: dict[str, list[str]]) -> list[str]:
    """List new items that belong to Firetwin."""
    found = []
    for kind, names in after.items():
        for name in sorted(set(names) - set(before[kind])):
            if kind in ("handlers", "properties", "shortcuts", "drawn in menus") or _ours(kind, name):
                found.append(f"{kind}: {name}")
    return found


def _ours(kind: str, name: str) -> bool:
    if "firetwin" in name.lower():
        return True
    return kind == "classes" and "firetwin" in getattr(bpy.types, name).__module__.lower()
