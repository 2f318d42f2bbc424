"""Reuse of data-blocks of the last build with equal inputs and without edits."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy
import numpy as np

from ...blender import owned, state
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...tiles.decoded import Decoded
from .slot import Slot

MADE_OF, STATE = "firetwin_made_of", "firetwin_state"
"""Properties of a data-block: digests of its inputs and of its built state."""
TILE, SLOTS, ORIGIN = "firetwin_tile", "firetwin_slots", "firetwin_origin"
"""Properties of a mesh: name of its decoded tile, slots of its pictures (JSON), place in the scene (m)."""


@dataclass
class Reusable:
    """Unchanged data-blocks of the last build.

    Attributes
    ----------
    meshes
        Meshes by the name of their decoded tile.
    materials, images
        Materials and images, in order.
    """

    meshes: dict[str, bpy.types.Mesh] = field(default_factory=dict)
    materials: list[bpy.types.Material] = field(default_factory=list)
    images: list[bpy.types.Image] = field(default_factory=list)


def find(stage: Stage, part: str, wanted: Sequence[str], made_of: Callable[[str], str]) -> Reusable:
    """Find the reusable data-blocks of the last build of a part.

    Parameters
    ----------
    wanted
        Names of decoded tiles.
    made_of
        Computes the digest of the other inputs of a tile's mesh.
    """
    kept, some = Reusable(), set(wanted)
    for obj in stage.objects_of(part):
        data = obj.data
        if not isinstance(data, bpy.types.Mesh) or not owned.is_ours(data) or TILE not in data:
            continue
        if not kept.materials and all(each is not None and MADE_OF in each for each in data.materials):
            kept.materials = list(data.materials)
        name = data[TILE]
        same = name in some and name not in kept.meshes and data.get(STATE) == state.digest_mesh(data)
        if same and data.get(MADE_OF) == made_of(name):
            kept.meshes[name] = data
    kept.images = [image for each in kept.materials for image in images(each)]
    return kept


def note(data: bpy.types.Mesh, name: str, made_of: str, tile: Decoded, slots: Mapping[str, Slot]) -> None:
    """Store the inputs of a mesh in its properties."""
    mine = {picture: (slots[picture].image, slots[picture].part) for picture in tile.pictures}
    data[TILE], data[MADE_OF], data[SLOTS] = name, made_of, json.dumps(mine)
    data[ORIGIN] = tile.origin.tolist()
    data[STATE] = state.digest_mesh(data)


def slots(data: bpy.types.Mesh) -> dict[str, Slot]:
    """Read the slots of a mesh's pictures."""
    return {picture: Slot(*at) for picture, at in json.loads(data[SLOTS]).items()}


def place_digest(shot: Shot) -> str:
    """Compute the digest of the inputs of `elevation` and `grid`: the scene's frame and the run's grid."""
    ground = shot.ground
    frame, fields = ground.frame, ground.fields
    digest = hashlib.sha256(repr((frame.latitude, frame.longitude, frame.height, fields.margin)).encode())
    for axis in (fields.latitude, fields.longitude):
        digest.update(np.asarray(axis).tobytes())
    return digest.hexdigest()[:32]


@contextmanager
def keep_alive(kept: Reusable) -> Iterator[None]:
    """Keep these data-blocks while their objects are removed."""
    blocks = [*kept.meshes.values(), *kept.materials, *kept.images]
    mine = [block for block in dict.fromkeys(blocks) if not block.use_fake_user]
    for block in mine:
        block.use_fake_user = True
    try:
        yield
    finally:
        for block in mine:
            block.use_fake_user = False


def images(material: bpy.types.Material) -> list[bpy.types.Image]:
    """List the images in the node tree of a material of tiles."""
    nodes = material.node_tree.nodes
    return [node.image for node in nodes if node.type == "TEX_IMAGE" and node.image is not None]
