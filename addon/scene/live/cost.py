"""Cost of a scene in a 3D view: triangles, instances, batches, and bytes of textures and volumes.

They describe the data for the graphics card; counting needs no card. A batch is a mesh with one material;
an engine draws each at least once. Textures count uncompressed: a byte per channel, or two or four of floats.
Volumes count with the size of their files of the current frame.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from . import switch


@dataclass(frozen=True)
class Cost:
    """Numbers of a scene as 3D views show it.

    Attributes
    ----------
    triangles
        Triangles drawn, instances included.
    instances
        Instances of objects that geometry nodes make.
    batches
        Pairs of a mesh (or volume) and one of its materials.
    texture_bytes, volume_bytes
        Memory of pictures that materials and world use; size of the volume files.
    """

    triangles: int
    instances: int
    batches: int
    texture_bytes: int
    volume_bytes: int

    @property
    def megabytes(self) -> float:
        """Memory of textures and volumes, MB."""
        return (self.texture_bytes + self.volume_bytes) / 1e6

    def text(self) -> str:
        """Describe the cost in one line."""
        return (
            f"{self.triangles / 1e6:.2f} million triangles, {self.instances} instances, "
            f"{self.batches} batches, {self.megabytes:.0f} MB of pictures and volumes"
        )


def measure(scene: bpy.types.Scene, live: bool | None = None) -> Cost:
    """Measure the scene that 3D views show now, the film's scene (False) or the live scene (True)."""
    before = switch.is_live(scene)
    if live is None or live == before or not switch.has_live(scene):
        return _measure(scene)
    switch.show_live(scene, live)
    try:
        return _measure(scene)
    finally:
        switch.show_live(scene, before)


def _measure(scene: bpy.types.Scene) -> Cost:
    layer = scene.view_layers[0]
    layer.update()
    triangles = instances = 0
    batches: set[tuple[str, str]] = set()
    materials: dict[str, bpy.types.Material] = {}
    sizes: dict[str, tuple[int, list[bpy.types.Material]]] = {}
    volumes: set[str] = set()
    for each in layer.depsgraph.object_instances:
        obj = each.object
        if obj.type not in ("MESH", "VOLUME") or not each.show_self or obj.data is None:
            continue
        instances += each.is_instance
        key = f"{obj.type} {obj.data.session_uid} {obj.data.name}"
        if key not in sizes:
            sizes[key] = _mesh(obj.data) if obj.type == "MESH" else _volume(obj.data, volumes)
        count, looks = sizes[key]
        triangles += count
        if count or obj.type == "VOLUME":
            batches.update((key, look.name) for look in looks)
            materials |= {look.name: look for look in looks}
    trees = [look.node_tree for look in materials.values()]
    if scene.world is not None:
        trees.append(scene.world.node_tree)
    images = {image.name: image for tree in trees for image in _images(tree, set())}
    return Cost(
        triangles,
        instances,
        len(batches),
        sum(_bytes(image) for image in images.values()),
        sum(os.path.getsize(path) for path in volumes if os.path.exists(path)),
    )


def _mesh(data: bpy.types.Mesh) -> tuple[int, list[bpy.types.Material]]:
    """Return the triangles of a mesh, and the materials of its faces."""
    return len(data.loops) - 2 * len(data.polygons), _materials(data)


def _volume(data: bpy.types.Volume, files: set[str]) -> tuple[int, list[bpy.types.Material]]:
    """Return no triangle, and the materials of a volume; add its file of the frame."""
    data.grids.load()
    files.add(bpy.path.abspath(data.grids.frame_filepath))
    return 0, _materials(data)


def _materials(data: bpy.types.Mesh | bpy.types.Volume) -> list[bpy.types.Material]:
    return [each.original for each in data.materials if each is not None]


def _images(tree: bpy.types.NodeTree | None, seen: set[str]) -> Iterator[bpy.types.Image]:
    """Iterate over the images of a node tree and its groups."""
    if tree is None or tree.name in seen:
        return
    seen.add(tree.name)
    for node in tree.nodes:
        if getattr(node, "image", None) is not None:
            yield node.image
        if node.type == "GROUP":
            yield from _images(node.node_tree, seen)


def _bytes(image: bpy.types.Image) -> int:
    width, height = image.size
    each = (2 if image.use_half_precision else 4) if image.is_float else 1
    return width * height * 4 * each
