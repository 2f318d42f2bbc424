"""Credits of what a collection shows, kept with it, so that a file that is opened again still names them."""

from __future__ import annotations

import json

import bpy

from ..blender.owned import Stage
from ..imaging.credits import Credits

PROPERTY = "firetwin_credits"
"""Property of a collection: credits and services' names as JSON."""


def note(collection: bpy.types.Collection, words: Credits) -> None:
    """Keep the credits of a collection."""
    if words:
        collection[PROPERTY] = json.dumps([words.data, words.logo])
    elif PROPERTY in collection:
        del collection[PROPERTY]


def of_scene(stage: Stage) -> Credits:
    """Credits of a scene, also of one that was opened from a file."""
    found = Credits()
    for part in stage.root.children:
        if PROPERTY in part and part.all_objects:
            data, logo = json.loads(part[PROPERTY])
            found = found.joined(Credits(tuple(data), tuple(logo)))
    return found
