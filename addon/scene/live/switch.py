"""Switch between the film's scene and the live one in 3D views; renders always show the film's scene.

Only collections are hidden and shown, so a switch builds nothing.
"""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ...blender import owned
from ...blender.owned import Stage

COLLECTION = "Live"
REPLACED = ("Terrain", "Forest", "Fire", "Smoke")
"""Parts of the film's scene that the live scene replaces."""
LABELS = "Live Labels"
"""Mark of the object that replaces the film's labels and signs."""
SUN = "Live Sun"
"""Mark of the lamp that replaces the film's sun."""
_LETTERED = ("Places", "Signs")  # marks of these objects


def collection(scene: bpy.types.Scene) -> bpy.types.Collection | None:
    """Return the collection "Firetwin Live" of a scene; None if it has none."""
    stage = owned.find_stage(scene)
    return None if stage is None else next(_parts(stage, COLLECTION), None)


def has_live(scene: bpy.types.Scene) -> bool:
    """Return True if a live scene was built."""
    found = collection(scene)
    return found is not None and bool(found.all_objects)


def is_live(scene: bpy.types.Scene) -> bool:
    """Return True if 3D views show the live scene."""
    found = collection(scene)
    return found is not None and bool(found.all_objects) and not found.hide_viewport


def show_live(scene: bpy.types.Scene, on: bool) -> None:
    """Show the live scene in 3D views instead of the film's, or the reverse; nothing without a live scene."""
    stage, live = owned.stage(scene), collection(scene)
    if live is None or not has_live(scene):
        return
    live.hide_render, live.hide_viewport = True, not on
    for name in REPLACED:
        for part in _parts(stage, name):
            part.hide_viewport = on
    replaced = replaced_objects(stage)
    for obj in _replaceable(stage):
        obj.hide_viewport = on and obj in replaced


def replaced_objects(stage: Stage) -> list[bpy.types.Object]:
    """Return objects of other parts of the film's scene that the live scene replaces: letters and sun."""
    live = collection(stage.scene)
    marks = {str(obj.get(owned.MARK)) for obj in live.all_objects} if live is not None else set()
    sun = film_sun(stage)
    return [obj for obj in _replaceable(stage) if (SUN if obj == sun else LABELS) in marks]


def _replaceable(stage: Stage) -> list[bpy.types.Object]:
    """Return the objects of other parts of the film's scene that a live scene can replace."""
    lettered = (obj for obj in stage.root.all_objects if any(owned.is_ours(obj, name) for name in _LETTERED))
    sun = film_sun(stage)
    return [*lettered, *([] if sun is None else [sun])]


def film_sun(stage: Stage) -> bpy.types.Object | None:
    """Return the lamp of the film's sun; None without one."""
    lamps = (obj for obj in stage.objects_of("Light") if obj.type == "LIGHT")
    return next((obj for obj in lamps if obj.data.type == "SUN"), None)


def empty(stage: Stage) -> bpy.types.Collection:
    """Return the collection of the live scene without objects; 3D views show the film's scene."""
    show_live(stage.scene, False)
    live = stage.part(COLLECTION)
    live.hide_render = live.hide_viewport = True
    return live


def _parts(stage: Stage, name: str) -> Iterator[bpy.types.Collection]:
    return (child for child in stage.root.children if owned.is_ours(child, name))
