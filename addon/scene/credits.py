"""Credits of data shown in a collection, stored with it, so that a reopened file still has them."""

from __future__ import annotations

import json
from typing import Any

import bpy

from ..blender import stored_json
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


def _parse(text: Any) -> Credits:
    """Parse stored credits; none if the text is not as `store` writes it."""
    lists = stored_json.parse(text)
    if not isinstance(lists, list) or len(lists) != 2 or not all(isinstance(each, list) for each in lists):
        return Credits()
    return Credits(*(tuple(text for text in each if isinstance(text, str)) for each in lists))


def read_scene(stage: Stage) -> Credits:
    """Read the credits of a scene, including one opened from a file."""
    found = Credits()
    for part in stage.root.children:
        if PROPERTY in part and part.all_objects:
            found = found.merge(_parse(part[PROPERTY]))
    return found
