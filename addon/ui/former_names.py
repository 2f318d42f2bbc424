"""Settings of .blend files that were saved while sections or keys had other names."""

from __future__ import annotations

import bpy

from ..blender import compat, owned
from ..shot.settings.settings import FORMER, FORMER_KEYS


@bpy.app.handlers.persistent
def adopt(*_: object) -> None:
    """Give settings and collections of sections that had other names to the sections."""
    for former, name in FORMER.items():
        for collection in bpy.data.collections:
            if owned.ours(collection, former.title()):
                owned.mark(collection, name.title())
                collection.name = f"Firetwin {name.title()}"
    for scene in bpy.data.scenes:
        stored = compat.stored(scene).get("firetwin", {})
        for former, name in FORMER.items():
            if former in stored:
                kept = stored[former].to_dict()
                for gone in {former, name} & {*stored.keys()}:
                    del stored[gone]
                stored[name] = kept
        for (section, former), name in FORMER_KEYS.items():
            if former in stored.get(section, {}):
                stored[section][name] = stored[section][former]
                del stored[section][former]


def register() -> None:
    """Adopt them whenever a file has been read."""
    bpy.app.handlers.load_post.append(adopt)


def unregister() -> None:
    """No longer."""
    bpy.app.handlers.load_post.remove(adopt)
