"""Tiles builder: a mesh for each chosen tile, which burns, glows and cools as the ground does.

A rebuild keeps what is the same (see `reuse`): of a cut that did not change no mesh, material or image is
made again.
"""

from __future__ import annotations

import bpy

from ...blender import owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.tile_cut import TileCut
from ...tiles import decoded
from ...tiles.decoded import Decoded
from .. import credits
from ..forest.stand import Stand
from . import material, mesh, pictures, reuse, slot
from .reuse import Kept
from .slot import Slot

PART = "Tiles"


def build(shot: Shot, stage: Stage, cut: TileCut, grown: Stand | None) -> None:
    """Build an object for each tile of the cut."""
    made_of = reuse.place_digest(shot)
    kept = reuse.find(stage, PART, cut.tiles, made_of)
    slots, new = _arranged(cut, kept)
    with reuse.held(kept):
        collection = stage.part(PART)
        credits.note(collection, cut.words)
        images = pictures.load(slots, cut.folder, kept.images)
        materials = material.build(shot, stage, images, grown, kept.materials)
        for name in cut.tiles:
            data = kept.meshes.get(name)
            if data is None:
                data = bpy.data.meshes.new(f"Firetwin Tile {name}")
                mesh.fill(data, shot, new[name], slots)
                reuse.note(data, name, made_of, new[name], slots)
            _assign(data, materials)
            owned.add(collection, f"Tile {name}", data).location = data[reuse.ORIGIN]
    owned.purge()


def remove(stage: Stage) -> None:
    """Remove the tiles of the last build."""
    if stage.objects_of(PART):
        stage.part(PART)


def _arranged(cut: TileCut, kept: Kept) -> tuple[dict[str, Slot], dict[str, Decoded]]:
    """Slots of all pictures, and the tiles to be built; what must move in its image is no longer kept."""
    new = {name: decoded.read(cut.folder / name) for name in cut.tiles if name not in kept.meshes}
    before = {name: reuse.slots(data) for name, data in kept.meshes.items()}
    known = {picture: at for each in before.values() for picture, at in each.items()}
    slots = slot.arrange([*known, *(each for tile in new.values() for each in tile.pictures)], known)
    for name, mine in before.items():
        if any(slots[picture] != at for picture, at in mine.items()):
            del kept.meshes[name]
            new[name] = decoded.read(cut.folder / name)
    return slots, new


def _assign(data: bpy.types.Mesh, materials: list[bpy.types.Material]) -> None:
    """Give a mesh these materials; those that it has already stay."""
    for number, each in enumerate(materials):
        if number == len(data.materials):
            data.materials.append(each)
        elif data.materials[number] != each:
            data.materials[number] = each
    while len(data.materials) > len(materials):
        data.materials.pop()
