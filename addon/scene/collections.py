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


def fresh(name: str, scene: bpy.types.Scene | None = None) -> bpy.types.Collection:
    """The empty collection "Firetwin <name>": an old one goes with its objects and their data."""
    full = f"{ROOT} {name}"
    old = bpy.data.collections.get(full)
    if old is not None:
        remove(old)
    collection = bpy.data.collections.new(full)
    root(scene).children.link(collection)
    return collection


def remove(collection: bpy.types.Collection) -> None:
    """Delete a collection, what is in it, and the data that only its objects used."""
    for child in list(collection.children):
        remove(child)
    for thing in list(collection.objects):
        data = thing.data
        action = thing.animation_data.action if thing.animation_data else None
        bpy.data.objects.remove(thing)
        unused = [block for block in (data, action) if block is not None and block.users == 0]
        bpy.data.batch_remove(unused)
    bpy.data.collections.remove(collection)


def add(collection: bpy.types.Collection, name: str, data: bpy.types.ID | None) -> bpy.types.Object:
    """A new object "Firetwin <name>" with `data` in `collection`."""
    thing = bpy.data.objects.new(f"{ROOT} {name}", data)
    collection.objects.link(thing)
    return thing
