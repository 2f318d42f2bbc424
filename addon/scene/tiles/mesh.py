"""Meshes of tiles: triangles with texture coordinates and colours, and the attributes of the ground."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender.mesh import add_attribute, fill_mesh
from ...shot.shot import Shot
from ...tiles.decoded import Decoded
from ..terrain import fields
from .flatten import flatten
from .skirt import add_skirt
from .slot import Slot

COLOUR = "tile_colour"
"""Linear colour of corners, multiplied with the picture."""
UV = "tile_uv"


def fill(data: bpy.types.Mesh, shot: Shot, tile: Decoded, slots: Mapping[str, Slot]) -> str:
    """Write the triangles of a tile into an empty mesh, with the attributes of the ground.

    Vegetation of the tile is flattened where the scene plants its own (`tiles.vegetation`). The mesh has a
    skirt at the border of the tiles.

    Returns
    -------
    Digest of these changes (see `shape_digest`).
    """
    plain = tile.without_points()
    found = add_skirt(shot, flatten(shot, plain))
    shape(data, found, slots)
    add_ground(data, shot, found.position, found.origin)
    return _digest(plain, found)


def shape(data: bpy.types.Mesh, tile: Decoded, slots: Mapping[str, Slot]) -> None:
    """Write a tile's triangles, colours and texture coordinates into an empty mesh."""
    tile = tile.without_points()
    _triangles(data, tile, np.ascontiguousarray(tile.position))
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
    add_attribute(data, COLOUR, "FLOAT_COLOR", colour, "CORNER")
    data.polygons.foreach_set("material_index", (image[tile.material_index] + 1).astype(np.int32))


def shape_digest(shot: Shot, tile: Decoded) -> str:
    """Compute the digest of a tile's changes by flattening and skirt; empty without changes."""
    plain = tile.without_points()
    return _digest(plain, add_skirt(shot, flatten(shot, plain)))


def _digest(plain: Decoded, found: Decoded) -> str:
    if found is plain:
        return ""
    digest = hashlib.sha256()
    for array in (found.position, found.normal, found.triangle):
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()[:32]


def add_ground(
    data: bpy.types.Mesh, shot: Shot, position: NDArray[np.float32], origin: NDArray[np.float64]
) -> None:
    """Write the vertex attributes of the ground's material: `elevation` and `grid`."""
    ground = shot.ground
    latitude, longitude, height = ground.frame.reverse(position.astype(np.float64) + origin)
    row, column = ground.indices(latitude, longitude)
    add_attribute(data, "elevation", "FLOAT", height)
    place = fields.texture_coordinates(ground.shape, row, column, ground.fields.margin)
    add_attribute(data, fields.GRID, "FLOAT_VECTOR", place)


def _triangles(data: bpy.types.Mesh, tile: Decoded, position: NDArray[np.float32]) -> None:
    """Write vertices, triangles and normals as arrays, so that the cost does not depend on the scene."""
    fill_mesh(data, position, tile.triangle)
    add_attribute(data, "custom_normal", "FLOAT_VECTOR", tile.normal)
