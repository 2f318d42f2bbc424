"""Preview of tiles: bounding boxes as one object of lines, and coarse tiles with plain materials."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import create_mesh
from ...blender.owned import Stage
from ...shot.tiles.tile_cut import TileCut
from ...tiles import decoded
from . import mesh, pictures, slot

PART = "Tile Preview"
BOXES = "Tile Boxes"
_EDGES = np.array([(a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1], np.int32)
"""Edges of a box whose corners are numbered by their signs."""


def show_boxes(stage: Stage, corners: NDArray[np.float64]) -> bpy.types.Object:
    """Show boxes (n, 8, 3), m in the scene, as one object hidden in renders; replaces an earlier preview."""
    collection = stage.part(PART)
    edges = (np.arange(len(corners), dtype=np.int32)[:, None, None] * 8 + _EDGES).reshape(-1, 2)
    data = create_mesh(f"Firetwin {BOXES}", corners.reshape(-1, 3), edges=edges)
    obj = owned.add(collection, BOXES, data)
    obj.hide_render, obj.display_type = True, "WIRE"
    return obj


def show_tiles(stage: Stage, cut: TileCut, boxes: bool = True) -> None:
    """Show the tiles of a cut in their colours, without light of the fire and without scar.

    Parameters
    ----------
    boxes
        Keep the boxes.
    """
    old = stage.objects_of(PART)
    collection = stage.part(PART, [obj for obj in old if boxes and not len(obj.data.polygons)])
    tiles = {name: decoded.read(cut.folder / name) for name in cut.tiles}
    slots = slot.arrange([each for tile in tiles.values() for each in tile.pictures])
    materials = [_material(image) for image in (None, *pictures.load(slots, cut.folder))]
    for name, tile in tiles.items():
        if not len(tile.triangle):
            continue
        data = bpy.data.meshes.new(f"Firetwin Tile Preview {name}")
        mesh.shape(data, tile, slots)
        for each in materials:
            data.materials.append(each)
        owned.add(collection, f"Tile Preview {name}", data).location = tile.origin


def remove(stage: Stage) -> None:
    """Remove the preview."""
    if stage.objects_of(PART):
        stage.part(PART)


def join(parts: Sequence[Sequence[float]]) -> NDArray[np.float64]:
    """Concatenate corners (n, 8, 3) of the boxes of several sources."""
    return np.concatenate([np.empty(0), *map(np.asarray, parts)]).reshape(-1, 8, 3)


def _material(image: bpy.types.Image | None) -> bpy.types.Material:
    new, tree = nodes.material(image.name if image else "Firetwin Tile Preview", (0.5, 0.5, 0.5))
    colour = tree.attribute(mesh.COLOUR, output="Color")
    if image:
        at = {"Vector": tree.attribute(mesh.UV, output="Vector")}
        shown = tree.output("ShaderNodeTexImage", at, image=image, extension="EXTEND")
        colour = tree.mix_colour(1.0, colour, shown, "MULTIPLY")
    tree.surface(tree.output("ShaderNodeBsdfDiffuse", {"Color": colour}))
    return new
