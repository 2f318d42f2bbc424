"""Tiles builder: a mesh for each selected tile, which burns, glows and cools like the ground.

A rebuild keeps unchanged meshes, materials and images (see `reuse`).
"""

from __future__ import annotations

import bpy

from ...blender import owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.tiles import tile_cut
from ...shot.tiles.tile_cut import TileCut
from ...tiles import decoded
from ...tiles.decoded import Decoded
from .. import credits
from ..forest.stand import Stand
from . import material, mesh, pictures, points, reuse, slot
from .reuse import Reusable
from .slot import Slot

PART = "Tiles"
_POINTS = " points"  # end of the names of point clouds


def build(shot: Shot, stage: Stage, cut: TileCut, grown: Stand | None) -> None:
    """Build an object for the triangles of each tile of the cut, and one for its points."""
    wanted = _pieces(cut)
    place = reuse.place_digest(shot)
    kept = reuse.find(stage, PART, wanted, lambda name: place + _shape_digest(shot, cut, name))
    slots, new = _arrange_slots(cut, wanted, kept)
    with reuse.keep_alive(kept):
        collection = stage.part(PART)
        credits.store(collection, cut.words)
        images = pictures.load(slots, cut.folder, kept.images)
        materials = material.build(shot, stage, images, grown, kept.materials)
        for name in wanted:
            data = kept.meshes.get(name)
            if data is None:
                data, tile = bpy.data.meshes.new(f"Firetwin Tile {name}"), new[_file(name)]
                shape = _fill(data, shot, tile, slots, name.endswith(_POINTS))
                reuse.note(data, name, place + shape, tile, slots)
            _assign(data, materials)
            obj = owned.add(collection, f"Tile {name}", data)
            obj.location = data[reuse.ORIGIN]
            if name.endswith(_POINTS):
                points.show(obj, stage, materials[0])
    owned.purge()


def _pieces(cut: TileCut) -> list[str]:
    """List the pieces of a cut's tiles by name: triangles and points."""
    names = []
    for name in cut.tiles:
        about = decoded.read_summary(cut.folder / name)
        if about is None or about.triangles or not about.points:
            names.append(name)
        if about is not None and about.points:
            names.append(name + _POINTS)
    return names


def _shape_digest(shot: Shot, cut: TileCut, name: str) -> str:
    """Compute the digest of a piece's changes by the heights of all tiles; empty without changes."""
    if name.endswith(_POINTS) or tile_cut.heights(shot) is None:
        return ""
    return mesh.shape_digest(shot, decoded.read(cut.folder / name))


def _file(piece: str) -> str:
    """Return the name of a piece's decoded tile."""
    return piece.removesuffix(_POINTS)


def _fill(data: bpy.types.Mesh, shot: Shot, tile: Decoded, slots: dict[str, Slot], cloud: bool) -> str:
    """Write a piece into an empty mesh; return the digest of its shape."""
    if not cloud:
        return mesh.fill(data, shot, tile, slots)
    points.fill(data, shot, tile)
    return ""


def remove(stage: Stage) -> None:
    """Remove the tiles of the last build."""
    if stage.objects_of(PART):
        stage.part(PART)


def _arrange_slots(
    cut: TileCut, wanted: list[str], kept: Reusable
) -> tuple[dict[str, Slot], dict[str, Decoded]]:
    """Arrange slots of all pictures; return them and the tiles to build (new, or with moved pictures)."""
    missing = dict.fromkeys(_file(name) for name in wanted if name not in kept.meshes)
    new = {name: decoded.read(cut.folder / name) for name in missing}
    before = {name: reuse.slots(data) for name, data in kept.meshes.items()}
    known = {picture: at for each in before.values() for picture, at in each.items()}
    slots = slot.arrange([*known, *(each for tile in new.values() for each in tile.pictures)], known)
    for name, mine in before.items():
        if any(slots[picture] != at for picture, at in mine.items()):
            del kept.meshes[name]
            new[_file(name)] = decoded.read(cut.folder / _file(name))
    return slots, new


def _assign(data: bpy.types.Mesh, materials: list[bpy.types.Material]) -> None:
    """Assign materials to a mesh where they differ."""
    for number, each in enumerate(materials):
        if number == len(data.materials):
            data.materials.append(each)
        elif data.materials[number] != each:
            data.materials[number] = each
    while len(data.materials) > len(materials):
        data.materials.pop()
