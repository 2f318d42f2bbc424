"""glTF forest: instances of plant models by EXT_mesh_gpu_instancing, in square cells.

A node has the plants of one model and level of detail in a cell. They are in random order, so that the first
of them are a sample of all. The instance attributes `_ID` and `_ARRIVAL` are the tree number of the pass
`masks`, and the time of the fire in seconds after the run's start (`NEVER` without fire). Trees are shown
before the fire.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..shot.terrain.terrain import NEVER
from ..tiles.make import glb
from .gltf_document import Document
from .gltf_terrain import normals
from .scene_content import LOOKS, Array, Numbers, Plants, Prototype, SceneContent

EXTENSION = "EXT_mesh_gpu_instancing"
_CELL = 4000.0  # m
_HEAVY = 10_000  # triangles; trees within a few tens of metres of a camera have 50,000
_MIXED = 2654435761  # multiplicative hash: Knuth, The Art of Computer Programming 3, section 6.4
_TWO_SIDED = ("foliage", "grass")
_CROWN = 0.4  # of the height: centre of the normals of foliage, by eye


def add(document: Document, content: SceneContent, start: float) -> None:
    """Append all plants.

    Parameters
    ----------
    start
        Model time of the run's start, s.
    """
    if not content.plants:
        return
    document.use(EXTENSION)
    root, models = document.node("forest"), _Models(document, content.prototypes)
    lighter = light_prototypes(content.prototypes)
    for each in content.plants:
        plants = replace(each, prototype=lighter[each.prototype])
        parent = document.node(plants.name.lower(), root)
        for (east, north, prototype), chosen in groups(plants):
            name = f"{content.prototypes[prototype].name} {east} {north}"
            instances = {"attributes": _instances(document, plants, chosen, start)}
            document.node(name, parent, mesh=models.number(prototype), extensions={EXTENSION: instances})


def light_prototypes(prototypes: list[Prototype]) -> Numbers:
    """Choose a prototype for each (n,): instead of one with every needle, the same model in the next level.

    Prototypes of one model whose other levels the scene does not use stay as they are.
    """
    choice = np.arange(len(prototypes))
    for k, heavy in enumerate(prototypes):
        same = [
            j
            for j, each in enumerate(prototypes)
            if _model(each) == _model(heavy) and each.level > heavy.level
        ]
        if len(heavy.triangles) > _HEAVY and same:
            choice[k] = min(same, key=lambda j: prototypes[j].level)
    return choice


def _model(prototype: Prototype) -> str:
    return prototype.name.rpartition("_level")[0]


def groups(plants: Plants) -> Iterator[tuple[tuple[int, int, int], Numbers]]:
    """Group plants by cell to the east and north, and prototype, in random order."""
    cell = np.floor(plants.position[:, :2] / _CELL).astype(np.int64)
    key = np.column_stack([cell, plants.prototype])
    mixed = np.arange(len(key)) * _MIXED % 2**32
    order = np.lexsort([mixed, *key.T[::-1]])
    ends = np.flatnonzero(np.any(np.diff(key[order], axis=0) != 0, axis=1)) + 1
    for chosen in np.split(order, ends):
        east, north, prototype = key[chosen[0]].tolist()
        yield (east, north, prototype), chosen


def _instances(document: Document, plants: Plants, chosen: Numbers, start: float) -> dict[str, int]:
    w, x, y, z = plants.rotation[chosen].T.astype(np.float64)
    turns = np.column_stack([x, z, -y, w])
    arrival = np.where(np.isfinite(plants.arrival), plants.arrival - start, NEVER)[chosen]
    attributes = {
        "TRANSLATION": document.vectors(plants.position[chosen], target=0),
        "ROTATION": document.buffer.accessor(turns, glb.SIGNED_SHORT, "VEC4", normalized=True),
        "SCALE": document.buffer.accessor(plants.scale[chosen][:, [0, 2, 1]], glb.FLOAT, "VEC3"),
        "_ARRIVAL": document.scalars(arrival),
    }
    return attributes if plants.ids is None else attributes | {"_ID": document.scalars(plants.ids[chosen])}


class _Models:
    """Meshes of prototypes, each added when it is first used."""

    def __init__(self, document: Document, prototypes: list[Prototype]) -> None:
        self._document, self._prototypes = document, prototypes
        self._meshes: dict[int, int] = {}
        self._materials: dict[str, int] = {}

    def number(self, prototype: int) -> int:
        """Return the number of a prototype's mesh."""
        if prototype not in self._meshes:
            self._meshes[prototype] = self._add(self._prototypes[prototype])
        return self._meshes[prototype]

    def _add(self, model: Prototype) -> int:
        parts = [self._part(model, int(look)) for look in np.unique(model.looks)]
        extras = {"model": _model(model), "class": model.kind, "state": model.state, "level": model.level}
        return self._document.add("meshes", {"name": model.name, "primitives": parts, "extras": extras})

    def _part(self, model: Prototype, look: int) -> dict[str, Any]:
        own = model.looks == look
        used, corner = np.unique(model.triangles[own], return_inverse=True)
        triangles, points = corner.reshape(-1, 3), model.points[used]
        colours = np.ones((len(used), 4))
        colours[triangles.ravel(), :3] = np.repeat(np.clip(model.colours[own], 0.0, 1.0), 3, axis=0)
        buffer, document = self._document.buffer, self._document
        attributes = {
            "POSITION": document.vectors(points, bounds=True),
            "NORMAL": document.vectors(_normals(LOOKS[look], points, triangles)),
            "COLOR_0": buffer.accessor(colours, glb.SHORT, "VEC4", glb.VERTICES, normalized=True),
        }
        indices = document.indices(triangles, len(points))
        return {"attributes": attributes, "indices": indices, "material": self._material(LOOKS[look])}

    def _material(self, look: str) -> int:
        if look not in self._materials:
            sides = {"doubleSided": True} if look in _TWO_SIDED else {}
            self._materials[look] = self._document.material(look, **sides)
        return self._materials[look]


def _normals(look: str, points: NDArray, triangles: NDArray) -> Array:
    """Compute normals (n, 3): of foliage away from the crown's centre, so that it is lit as one body."""
    if look not in _TWO_SIDED:
        return normals(points, triangles)
    away = np.asarray(points, np.float64) - (0.0, 0.0, _CROWN)
    away[:, :2] *= 2.0  # crowns are about twice as tall as wide
    return away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1.0e-9)
