"""Materials of tiles: the ground's material with colours of the tiles' pictures; reused if unchanged."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np

from ...blender import nodes, owned, state
from ...blender.owned import Stage
from ...shot.sections import TileSettings
from ...shot.settings import code_fingerprint
from ...shot.shot import Shot
from ...shot.surface import land_use, orthophoto
from ..forest.stand import Stand
from ..terrain import fields, material
from . import reuse
from .mesh import COLOUR, UV
from .reuse import MADE_OF, STATE

_NAME = "Firetwin Tiles"


def build(
    shot: Shot,
    stage: Stage,
    images: list[bpy.types.Image],
    grown: Stand | None,
    materials: list[bpy.types.Material],
) -> list[bpy.types.Material]:
    """Build a material for tiles without a picture, and one for each image; all share one node group.

    Parameters
    ----------
    materials
        Materials of the last build.
    """
    made_of = _inputs(shot, images)
    same = [each.get(MADE_OF) for each in materials] == [made_of] * (1 + len(images))
    same = same and [image for each in materials for image in reuse.images(each)] == images
    if same and all(each[STATE] == state.digest_material(each) for each in materials):
        return materials
    first = material.build(shot, stage, fields.create_images(shot, grown), skin=_NAME)
    others = [owned.mark(first.copy()) for _ in images]
    colour(first, None)
    for other, image in zip(others, images, strict=True):
        other.name = image.name
        colour(other, image)
    for each in (first, *others):
        each[MADE_OF], each[STATE] = made_of, state.digest_material(each)
    return [first, *others]


def colour(tiles: bpy.types.Material, image: bpy.types.Image | None, vertices: str = COLOUR) -> None:
    """Connect the colour of the mesh (`vertices`), multiplied with a picture, to a material's group."""
    tree = nodes.Tree(tiles.node_tree)
    shown = tree.attribute(vertices, output="Color")
    if image:
        at = {"Vector": tree.attribute(UV, output="Vector")}
        picture = tree.output("ShaderNodeTexImage", at, image=image, extension="EXTEND")
        shown = tree.mix_colour(1.0, shown, picture, "MULTIPLY")
    group = next(node for node in tree.node_tree.nodes if node.type == "GROUP")
    tree.connect(shown, group.inputs[material.TILE_COLOUR])


def _inputs(shot: Shot, images: list[bpy.types.Image]) -> str:
    """Digest of all that the materials depend on: settings, the run's data, heights, code, and the images."""
    settings = replace(shot.settings, path=Path(), run=Path(), cache=Path(), tiles=TileSettings())
    read = shot.input_hashes() | orthophoto.inputs(shot.settings) | land_use.inputs(shot.settings)
    read = {name: digest for name, digest in read.items() if not name.startswith("tiles ")}
    code = code_fingerprint.hashes({"terrain", "forest"}, shot.settings.cameras)
    digest = hashlib.sha256(repr((settings, read, code, [each[MADE_OF] for each in images])).encode())
    digest.update(np.asarray(shot.ground.fields.elevation).tobytes())
    digest.update(shot.built_frames.tobytes())
    return digest.hexdigest()[:32]
