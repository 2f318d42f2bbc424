"""Credits of data shown in a collection, stored with it, so that a reopened file still has them."""

from __future__ import annotations

import json

import bpy

from ..blender.owned import Stage
from ..imaging.credits import Credits

PROPERTY = "firetwin_credits"
"""Property of a collection: credits and services' names as JSON."""


def store(collection: bpy.types.Collection, credits: Credits) -> None:
    """Store the credits of a collection."""
    if credits:
        collection[PROPERTY] = json.dumps([credits.data, credits.logo])
    elif PROPERTY in collection:
        del collection[PROPERTY]


def read_scene(stage: Stage) -> Credits:
    """Read the credits of a scene, including one opened from a file."""
    found = Credits()
    for part in stage.root.children:
        if PROPERTY in part and part.all_objects:
            data, logo = json.loads(part[PROPERTY])
            found = found.merge(Credits(tuple(data), tuple(logo)))
    return found
