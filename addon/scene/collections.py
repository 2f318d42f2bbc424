"""Collections of the scene: "Firetwin" and its parts, made afresh by every build."""

from __future__ import annotations

import bpy

ROOT = "Firetwin"
PARTS = ("Terrain", "Forest", "Fire", "Smoke", "Cameras", "Light")


def root(scene: bpy.types.Scene | None = None) -> bpy.types.Collection:
    """The collection that holds all others, linked to the scene."""
    scene = scene or bpy.context.scene
    collection = bpy.data.collections.get(ROOT) or bpy.data.collections.new(ROOT)
    if collection.name not in scene.collection.children:
        scene.collection.children.link(collection)
    return collection


def fresh(
    name: str, scene: bpy.types.Scene | None = None, parent: bpy.types.Collection | None = None
) -> bpy.types.Collection:
    """The empty collection "Firetwin <name>": an old one goes with its objects and their data."""
    full = f"{ROOT} {name}"
    old = bpy.data.collections.get(full)
    if old is not None:
        remove(old)
    collection = bpy.data.collections.new(full)
    (parent or root(scene)).children.link(collection)
    return collection


def remove(collection: bpy.types.Collection) -> None:
    """Delete a collection, what is in it, and the data that only its objects used."""
    for child in list(collection.children):
        remove(child)
    things = list(collection.objects)
    data = {thing.data for thing in things if thing.data is not None}
    bpy.data.collections.remove(collection)
    discard(*things)
    discard(*(block for block in data if block.users == 0))


def discard(*blocks: bpy.types.ID) -> None:
    """Delete data and the animation that goes with it, also that of its shader nodes."""
    owners = [*blocks, *(block.node_tree for block in blocks if getattr(block, "node_tree", None))]
    actions = {owner.animation_data.action for owner in owners if owner.animation_data} - {None}
    bpy.data.batch_remove(blocks)
    bpy.data.batch_remove([action for action in actions if action.users == 0])


def add(collection: bpy.types.Collection, name: str, data: bpy.types.ID | None) -> bpy.types.Object:
    """A new object "Firetwin <name>" with `data` in `collection`."""
    thing = bpy.data.objects.new(f"{ROOT} {name}", data)
    collection.objects.link(thing)
    return thing
