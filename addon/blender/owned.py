"""Ownership of Blender data: data-blocks with Firetwin's mark, under one root collection per scene.

Other data are never changed or removed: an artist's objects in owned collections, other scenes, linked data.
Engine, world, view layers and compositor belong to the scene, so they are set only in owned scenes.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

import bpy

from ..errors import Error

MARK = "firetwin_part"  # not "firetwin", which holds the panel's settings
NAME = "firetwin_name"  # name of an object when it was built; copies have it too
ROOT = "Firetwin"
MADE = "made"  # a scene that Firetwin created


def mark(block: Any, what: str = "") -> Any:
    """Mark a data-block, view layer or node as owned; `what` identifies it."""
    block[MARK] = what or True
    return block


def unmark(block: Any) -> None:
    """Remove the mark; from then on it belongs to the artist."""
    for name in (MARK, NAME):
        if name in block:
            del block[name]


def is_ours(block: Any, what: str = "") -> bool:
    """Return True if local data have the mark (and this `what`, unless empty)."""
    linked = getattr(block, "library", None) or getattr(block, "override_library", None)
    if linked is not None or MARK not in block:
        return False
    return not what or block[MARK] == what


@dataclass(frozen=True)
class Stage:
    """Owned part of a scene: its root collection and the contents."""

    scene: bpy.types.Scene
    root: bpy.types.Collection

    @property
    def is_own(self) -> bool:
        """True if the scene itself is owned."""
        return is_ours(self.scene)

    def part(self, name: str, keep: Collection[bpy.types.Object] = ()) -> bpy.types.Collection:
        """Return the collection "Firetwin <name>" without owned objects except `keep`; other objects stay."""
        collection = next((child for child in self.root.children if is_ours(child, name)), None)
        if collection is not None:
            _clear(collection, keep)
            purge()
            return collection
        return child(self.root, name)

    def objects_of(self, name: str) -> list[bpy.types.Object]:
        """Return the owned objects of a part."""
        collections = (child for child in self.root.children if is_ours(child, name))
        return [obj for child in collections for obj in child.all_objects if is_ours(obj)]

    def evaluated(self, block: Any) -> Any:
        """Evaluate a data-block at the scene's frame, even if another scene is the current one."""
        layers = self.scene.view_layers
        layer = next((each for each in layers if is_ours(each)), layers[0])
        return block.evaluated_get(layer.depsgraph) if layer.depsgraph else block

    def camera(self, name: str) -> bpy.types.Object | None:
        """Find the object of the camera called `name` in the scene file, even if the object was renamed."""
        matches = [obj for obj in self.root.all_objects if is_ours(obj, f"camera {name}")]
        return min(matches, key=_originality, default=None)


def has_data(scene: bpy.types.Scene) -> bool:
    """Return True if a scene has owned data."""
    return is_ours(scene) or _root(scene) is not None


def scene(uid: int) -> bpy.types.Scene:
    """Find the scene with this `session_uid`, which renaming and undo preserve.

    Raises
    ------
    Error
        The scene no longer exists.
    """
    match = next((each for each in bpy.data.scenes if each.session_uid == uid), None)
    if match is None:
        raise Error("the scene is gone: it was deleted, undone, or another file was opened; build it again")
    return match


def find_stage(scene: bpy.types.Scene) -> Stage | None:
    """Return the owned part of a scene; None if it is missing."""
    root = _root(scene)
    return None if root is None else Stage(scene, root)


def stage(scene: bpy.types.Scene) -> Stage:
    """Return the owned part of a scene; create it if it is missing."""
    root = _root(scene)
    return Stage(scene, root if root is not None else child(scene.collection, ""))


def new_scene() -> bpy.types.Scene:
    """Create an owned scene "Firetwin", marked as `MADE`: it may be deleted when it is empty."""
    made = bpy.data.scenes.new(ROOT)
    adopt(made, MADE)
    return made


def adopt(scene: bpy.types.Scene, what: str = "") -> Stage:
    """Mark a new or empty scene as owned, and return its owned part."""
    if not is_ours(scene):
        mark(scene, what)
        if len(scene.view_layers) == 1:  # the default one of every new scene
            mark(scene.view_layers[0], "spare")
    return stage(scene)


def remove(scene: bpy.types.Scene) -> None:
    """Remove all owned data from a scene, and nothing else.

    Collections with an artist's objects stay, as do data that another scene uses.
    """
    root = _root(scene)
    if root is not None and any(root in set(other.collection.children) for other in _others(scene)):
        scene.collection.children.unlink(root)
    elif root is not None:
        for name in [name for name, value in root.items() if isinstance(value, bpy.types.ID)]:
            del root[name]
        _clear(root)
        _drop(root)
    if is_ours(scene) and scene.world is not None and is_ours(scene.world):
        scene.world = None
    unmark(scene)
    purge()


def child(parent: bpy.types.Collection, name: str) -> bpy.types.Collection:
    """Create an owned collection "Firetwin <name>" in `parent`."""
    collection = library(name)
    parent.children.link(collection)
    return collection


def library(name: str) -> bpy.types.Collection:
    """Create an owned collection "Firetwin <name>" outside of all scenes."""
    return mark(bpy.data.collections.new(f"{ROOT} {name}".strip()), name or "root")


def add(
    collection: bpy.types.Collection, name: str, data: bpy.types.ID | None, what: str = ""
) -> bpy.types.Object:
    """Create an owned object "Firetwin <name>" with `data`, which is marked too, in `collection`."""
    obj = mark(bpy.data.objects.new(f"{ROOT} {name}", data), what)
    obj[NAME] = obj.name
    if data is not None:
        mark(data)
    collection.objects.link(obj)
    return obj


def purge() -> None:
    """Delete owned data-blocks without users, and the owned data-blocks that only they used."""
    while unused := [block for block in _blocks() if block.users == 0 and is_ours(block)]:
        bpy.data.batch_remove(unused)


def _root(scene: bpy.types.Scene) -> bpy.types.Collection | None:
    return next((child for child in scene.collection.children if is_ours(child, "root")), None)


def _others(scene: bpy.types.Scene) -> list[bpy.types.Scene]:
    return [other for other in bpy.data.scenes if other != scene]


def _clear(collection: bpy.types.Collection, keep: Collection[bpy.types.Object] = ()) -> None:
    """Delete owned objects in a collection except `keep`, and then owned empty collections."""
    for inner in list(collection.children):
        if is_ours(inner):
            _clear(inner, keep)
            _drop(inner)
    originals: dict[str, bpy.types.Object] = {}
    for obj in sorted(filter(is_ours, collection.objects), key=_originality):
        if originals.setdefault(obj.get(NAME), obj) != obj:
            unmark(obj)  # an artist's copy
    bpy.data.batch_remove([obj for obj in originals.values() if obj not in keep])


def _originality(obj: bpy.types.Object) -> tuple[bool, int]:
    """Return a sort key that puts an object before its copies by the user."""
    return obj.name != obj.get(NAME), obj.session_uid


def _drop(collection: bpy.types.Collection) -> None:
    if not collection.objects and not collection.children:
        bpy.data.collections.remove(collection)


def _blocks() -> Iterator[bpy.types.ID]:
    """Iterate over every data-block in the file except scenes."""
    for prop in bpy.data.bl_rna.properties:
        if prop.type == "COLLECTION" and prop.identifier not in ("scenes", "libraries", "screens"):
            yield from getattr(bpy.data, prop.identifier)
