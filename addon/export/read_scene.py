"""Scene reader: reads the built scene in Blender into the arrays of `scene_content`.

Plants are points with attributes, on which geometry nodes instance models (`scene.forest.build`). The reader
takes these points and models themselves: Blender's list of evaluated instances takes seconds for a forest.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender import compat, owned
from ..blender.owned import Stage
from ..scene.forest import biomes, models
from ..scene.forest.levels import LEVELS
from ..scene.forest.material import LOW_BARE_AFTER, TORCHING, burning_share
from ..shot.shot import Shot
from ..shot.terrain.terrain import NEVER
from . import mesh_order, tracks
from .scene_content import (
    LOOKS,
    FlamePoints,
    Floats,
    Plants,
    Prototype,
    SceneContent,
    SmokeLayer,
    TerrainMesh,
)

PLANTS = ("Trees", "Understorey", "Grass")
_LOOKS = {"Foliage": 0, "Bark": 1, "Snag": 2, "Rock": 3, "Grass": 4}  # by the name of Firetwin's materials
_CHAR, _ROCK = (0.020, 0.018, 0.017), (0.26, 0.25, 0.24)  # means of the materials' colours


def read(shot: Shot, stage: Stage, frames: Sequence[int], smoke: Sequence[SmokeLayer] = ()) -> SceneContent:
    """Read terrain, plants, flames and cameras of a built scene.

    Parameters
    ----------
    frames
        Exported frames, ascending, from 1.
    smoke
        Volume files, which the scene only refers to.
    """
    numbers = np.array(sorted(frames), np.int64)
    library = _Library(shot)
    plants = [found for name in PLANTS if (found := _read_plants(shot, stage, name, library)) is not None]
    return SceneContent(
        frames=numbers,
        times=np.array([shot.frames.time(int(frame)) for frame in numbers]),
        rate=float(shot.settings.time.rate),
        terrain=_read_terrain(stage),
        prototypes=library.prototypes,
        plants=plants,
        flames=_read_flames(shot, stage),
        cameras=[tracks.make(shot, view, numbers) for view in shot.paths],
        smoke=list(smoke),
    )


def _find(stage: Stage, part: str, name: str) -> bpy.types.Object | None:
    """Find the rendered object that a part was built with, also if an artist renamed it."""
    named = [obj for obj in stage.objects_of(part) if obj.get(owned.NAME) == f"{owned.ROOT} {name}"]
    return named[0] if named else None


def read_values(data: bpy.types.Mesh, name: str, size: int = 1) -> NDArray:
    """Read an attribute of a mesh: (n,) values or (n, size) vectors."""
    attribute = data.attributes[name]
    whole = attribute.data_type in ("INT", "BOOLEAN")
    values = np.empty(size * len(attribute.data), np.int32 if whole else np.float32)
    key = {"FLOAT_COLOR": "color", "FLOAT_VECTOR": "vector"}.get(attribute.data_type, "value")
    attribute.data.foreach_get(key, values)
    return values.reshape(-1, size) if size > 1 else values


def _triangles(data: bpy.types.Mesh) -> NDArray[np.int64]:
    """Read the triangles (m, 3) of a mesh, whose polygons Blender may have to divide."""
    data.calc_loop_triangles()
    corners = np.empty(3 * len(data.loop_triangles), np.int32)
    data.loop_triangles.foreach_get("vertices", corners)
    return corners.reshape(-1, 3).astype(np.int64)


def _read_terrain(stage: Stage) -> TerrainMesh | None:
    obj = _find(stage, "Terrain", "Ground")
    if obj is None:
        return None
    data = obj.data
    normals = np.empty(3 * len(data.vertices), np.float32)
    data.vertex_normals.foreach_get("vector", normals)
    uv = read_values(data, "grid", 3)[:, :2]
    order = mesh_order.along_curve(uv)
    return TerrainMesh(
        points=read_values(data, "position", 3)[order],
        triangles=mesh_order.reorder(_triangles(data), order),
        normals=normals.reshape(-1, 3)[order],
        uv=uv[order],
    )


class _Library:
    """Prototypes that plants use, each read once from the collection of models."""

    def __init__(self, shot: Shot) -> None:
        self.prototypes: list[Prototype] = []
        self._index: dict[tuple[str, int], int] = {}
        straw, green = biomes.choose(shot).biome.grass
        self._grass = 0.5 * (np.array(straw) + np.array(green))
        self._kinds = models.every()

    def indices(self, library: bpy.types.Collection, model: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the indices of prototypes (n,) for models (n,), as geometry nodes count them."""
        known = sorted(library.objects, key=lambda obj: obj.name)
        used, number = np.unique(model, return_inverse=True)
        return np.array([self._add(library.name, known, int(k)) for k in used], np.int64)[number]

    def _add(self, library: str, known: list[bpy.types.Object], k: int) -> int:
        if (library, k) not in self._index:
            self._index[library, k] = len(self.prototypes)
            self.prototypes.append(self._prototype("Grass" in library, known[k].data, k))
        return self._index[library, k]

    def _prototype(self, grass: bool, data: bpy.types.Mesh, k: int) -> Prototype:
        number, level = (k, 0) if grass else divmod(k, LEVELS)
        kind, state = ("grass", "living") if grass else (self._kinds[number].kind, self._kinds[number].state)
        triangles = _triangles(data)
        polygon, slot = (np.empty(len(triangles), np.int32), np.zeros(len(data.polygons), np.int32))
        data.loop_triangles.foreach_get("polygon_index", polygon)
        data.polygons.foreach_get("material_index", slot)
        colours, looks = self._surface(data, triangles, slot[polygon])
        return Prototype(
            name=f"{kind}_{number:02d}_{state}_level{level}",
            kind=kind,
            state=state,
            level=level,
            points=read_values(data, "position", 3),
            triangles=triangles,
            colours=colours.astype(np.float32),
            looks=looks,
        )

    def _surface(
        self, data: bpy.types.Mesh, triangles: NDArray[np.int64], slot: NDArray[np.int32]
    ) -> tuple[NDArray, NDArray[np.int64]]:
        """Return the colour (m, 3) and the look (m,) of each triangle."""
        slots = [material.name if material else "" for material in data.materials] or [""]
        each = [_look(name) for name in slots]
        plain = [
            _flat_colour(data.materials[i]) if i < len(data.materials) else None for i in range(len(each))
        ]
        index = np.minimum(slot, len(each) - 1)
        looks = np.array(each, np.int64)[index]
        colours = np.full((len(triangles), 3), 0.2)
        if "leaf" in data.attributes:
            colours = read_values(data, "leaf", 4)[triangles[:, 0], :3].astype(np.float64)
        fixed = {LOOKS.index("char"): _CHAR, LOOKS.index("rock"): _ROCK, LOOKS.index("grass"): self._grass}
        for look, colour in fixed.items():
            colours[looks == look] = colour
        for i, colour in enumerate(plain):
            if colour is not None:
                colours[index == i] = colour
        return colours, looks


def _look(material: str) -> int:
    """Return the look of a material of Firetwin; an artist's counts as bark."""
    words = material.split()
    name = words[1].partition(".")[0] if len(words) > 1 and words[0] == "Firetwin" else ""
    return _LOOKS.get(name, LOOKS.index("bark"))


def _flat_colour(material: bpy.types.Material | None) -> NDArray | None:
    """Return the base colour of an artist's material; None for Firetwin's."""
    if material is None or material.name.startswith("Firetwin "):
        return None
    tree = material.node_tree
    for node in tree.nodes if tree else ():
        if node.type == "BSDF_PRINCIPLED":
            return np.array(node.inputs["Base Color"].default_value[:3])
    return np.array(material.diffuse_color[:3])


def _read_plants(shot: Shot, stage: Stage, name: str, library: _Library) -> Plants | None:
    obj = _find(stage, "Forest", name)
    if obj is None or not len(obj.data.vertices):
        return None
    data = obj.data
    info = next(
        node for node in obj.modifiers[0].node_group.nodes if node.bl_idname == "GeometryNodeCollectionInfo"
    )
    models_of = compat.find_socket(info.inputs, "Collection").default_value
    arrival = read_values(data, "arrival_time")
    arrival[arrival >= NEVER] = np.inf
    height, width = read_values(data, "scale"), read_values(data, "width")
    turns = [
        read_values(data, turn) if turn in data.attributes else np.zeros(len(height), np.float32)
        for turn in ("roll", "pitch", "rotation")
    ]
    living, snags = (read_values(data, key).astype(np.int64) for key in ("model", "snag_model"))
    number = read_values(data, "number") if "number" in data.attributes else None
    snags = np.where(np.isfinite(arrival) & (arrival <= shot.frames.last), snags, living)
    both = library.indices(models_of, np.concatenate([living, snags]))
    return Plants(
        name=name,
        position=read_values(data, "position", 3),
        rotation=euler_quaternions(*turns),
        scale=np.stack([height * width, height * width, height], axis=-1),
        ids=None if number is None else number.astype(np.int64),
        prototype=both[: len(living)],
        burned_prototype=both[len(living) :],
        burned_from=(arrival + _bare_after(shot, data, name == "Understorey")).astype(np.float32),
        arrival=arrival,
        scorch=read_values(data, "scorch"),
        torched=read_values(data, "torched"),
    )


def _bare_after(shot: Shot, data: bpy.types.Mesh, low: bool) -> NDArray:
    """Return the time (n,), s, from the fire to a bare plant, as `scene.forest.build` has it far away."""
    if not low:
        return np.full(len(data.vertices), TORCHING)
    soonest, latest = (TORCHING * burning_share(shot) * part for part in LOW_BARE_AFTER)
    return soonest + (latest - soonest) * read_values(data, "tint")


def euler_quaternions(roll: NDArray, pitch: NDArray, yaw: NDArray) -> Floats:
    """Return unit quaternions (n, 4), w, x, y, z, of turns (n,) about x, then y, then z, in radians."""
    cr, cp, cy = (np.cos(0.5 * turn.astype(np.float64)) for turn in (roll, pitch, yaw))
    sr, sp, sy = (np.sin(0.5 * turn.astype(np.float64)) for turn in (roll, pitch, yaw))
    return np.stack(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ],
        axis=-1,
    ).astype(np.float32)


def _read_flames(shot: Shot, stage: Stage) -> FlamePoints | None:
    obj = _find(stage, "Fire", "Flames")
    if obj is None or not len(obj.data.vertices):
        return None
    names = (
        "arrival_time",
        "residence",
        "flame_length",
        "flame_width",
        "tilt",
        "kelvin",
        "intensity",
        "seed",
    )
    arrival, residence, length, width, tilt, kelvin, intensity, seed = (
        read_values(obj.data, name) for name in names
    )
    place = read_values(obj.data, "position", 3)
    return FlamePoints(
        place, arrival, residence, length, width, tilt, kelvin, intensity, seed, wind=shot.wind
    )
