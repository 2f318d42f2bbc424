"""Tiles builder: a mesh for each chosen tile, which burns, glows and cools as the ground does."""

from __future__ import annotations

import json

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.tile_cut import TileCut
from ...tiles import decoded
from ...tiles.decoded import Decoded
from ..forest.stand import Stand
from ..terrain import fields, material
from . import pictures
from .pictures import Slot

COLOUR = "tile_colour"
"""Point attribute: linear colour, multiplied with the picture."""
UV = "tile_uv"
CREDITS = "firetwin_tile_credits"
"""Property of the collection of tiles: credits and services' names as JSON, so that files keep them."""


def build(shot: Shot, stage: Stage, cut: TileCut, grown: Stand | None) -> None:
    """Build an object for each tile of the cut."""
    tiles = {name: decoded.read(cut.folder / name) for name in cut.tiles}
    slots = pictures.arrange(
        [each.picture for tile in tiles.values() for each in tile.materials if each.picture]
    )
    collection = stage.part("Tiles")
    collection[CREDITS] = json.dumps([cut.credits, cut.logo])
    materials = _materials(shot, stage, pictures.load(slots, cut.folder, cut.name), grown)
    for name, tile in tiles.items():
        data = bpy.data.meshes.new(f"Firetwin Tile {name}")
        fill(data, shot, tile, slots)
        for each in materials:
            data.materials.append(each)
        owned.add(collection, f"Tile {name}", data).location = tile.origin


def _materials(
    shot: Shot, stage: Stage, images: list[bpy.types.Image], grown: Stand | None
) -> list[bpy.types.Material]:
    """A material for tiles without a picture, and one for each image: all use one group of nodes."""
    first = material.build(shot, stage, fields.images(shot, grown), skin="Firetwin Tiles")
    others = [owned.mark(first.copy()) for _ in images]
    _colour(first, None)
    for other, image in zip(others, images, strict=True):
        other.name = image.name
        _colour(other, image)
    return [first, *others]


def _colour(tiles: bpy.types.Material, image: bpy.types.Image | None) -> None:
    """Give a material's group the colour of the mesh, multiplied with a picture."""
    tree = nodes.Tree(tiles.node_tree)
    colour = tree.attribute(COLOUR, output="Color")
    if image:
        at = {"Vector": tree.attribute(UV, output="Vector")}
        shown = tree.output("ShaderNodeTexImage", at, image=image, extension="EXTEND")
        colour = tree.mix_colour(1.0, colour, shown, "MULTIPLY")
    group = next(node for node in tree.node_tree.nodes if node.type == "GROUP")
    tree.connect(colour, group.inputs[material.TILE_COLOUR])


def fill(data: bpy.types.Mesh, shot: Shot, tile: Decoded, slots: dict[str, Slot]) -> None:
    """Write a tile into an empty mesh, with the attributes of the ground: `elevation` and `grid`."""
    _shape(data, tile)
    ground = shot.ground
    latitude, longitude, height = ground.frame.reverse(tile.position.astype(np.float64) + tile.origin)
    row, column = ground.indices(latitude, longitude)
    _attribute(data, "elevation", "FLOAT", height)
    _attribute(
        data, fields.GRID, "FLOAT_VECTOR", fields.place(ground.shape, row, column, ground.fields.margin)
    )
    corners = tile.triangle.ravel()
    index = np.repeat(tile.material_index, 3)
    uv, colour = tile.uv[corners], np.ones((len(corners), 4), np.float32)
    if len(tile.colour):
        colour = tile.colour[corners].copy()
    image = np.full(len(tile.materials), -1)
    for number, each in enumerate(tile.materials):
        mine = index == number
        colour[mine] *= np.asarray(each.colour, np.float32)
        if slot := slots.get(each.picture):
            uv[mine], image[number] = slot.moved(uv[mine]), slot.image
    layer = data.uv_layers.new(name=UV)
    layer.data.foreach_set("uv", np.ascontiguousarray(uv).ravel())
    data.attributes.new(COLOUR, "FLOAT_COLOR", "CORNER").data.foreach_set("color", colour.ravel())
    data.polygons.foreach_set("material_index", (image[tile.material_index] + 1).astype(np.int32))


def _shape(data: bpy.types.Mesh, tile: Decoded) -> None:
    """Vertices, triangles and normals; arrays only, so that a tile costs the same in any scene."""
    data.vertices.add(len(tile.position))
    data.attributes["position"].data.foreach_set("vector", np.ascontiguousarray(tile.position).ravel())
    data.loops.add(tile.triangle.size)
    data.attributes[".corner_vert"].data.foreach_set("value", tile.triangle.ravel())
    data.polygons.add(len(tile.triangle))
    data.polygons.foreach_set("loop_start", np.arange(0, tile.triangle.size, 3, dtype=np.int32))
    data.update(calc_edges=True)
    data.normals_split_custom_set_from_vertices(tile.normal)


def _attribute(data: bpy.types.Mesh, name: str, kind: str, values: NDArray) -> None:
    key = "value" if kind == "FLOAT" else "vector"
    data.attributes.new(name, kind, "POINT").data.foreach_set(key, np.asarray(values, np.float32).ravel())
