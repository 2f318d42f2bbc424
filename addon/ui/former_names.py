"""Migration of .blend files with former names of sections or keys.

Choices are stored as numbers, which do not change when their names do.
"""

from __future__ import annotations

import json

import bpy

from ..blender import compat, owned
from ..shot.schema.former import FORMER, FORMER_KEYS


@bpy.app.handlers.persistent
def adopt(*_: object) -> None:
    """Move settings and collections of renamed sections to their current names."""
    for former, name in FORMER.items():
        for collection in bpy.data.collections:
            if owned.is_ours(collection, former.title()):
                owned.mark(collection, name.title())
                collection.name = f"Firetwin {name.title()}"
    for scene in bpy.data.scenes:
        stored = compat.stored_properties(scene).get("firetwin", {})
        for former, name in FORMER.items():
            if former in stored:
                kept = stored[former].to_dict()
                for gone in {former, name} & {*stored.keys()}:
                    del stored[gone]
                stored[name] = kept
        for (section, former), name in FORMER_KEYS.items():
            kept = stored.get(section, {})
            if former in kept:
                kept[name] = kept[former]
                del kept[former]
            exact = json.loads(kept.get("exact") or "{}")  # see `keys`
            if former in exact:
                kept["exact"] = json.dumps(exact | {name: exact.pop(former)})


def register() -> None:
    """Migrate each file after it was loaded."""
    bpy.app.handlers.load_post.append(adopt)


def unregister() -> None:
    """Stop the migration of loaded files."""
    bpy.app.handlers.load_post.remove(adopt)
