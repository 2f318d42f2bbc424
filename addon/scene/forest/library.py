"""Model library: Firetwin's models in Blender, and an artist's replacements.

An artist's models are the objects of a collection named "Firetwin Models" with these custom properties:

class
    "large", "medium", "small", "oak", "brush", "log", "rock", "tuft", "twigs", "pine", "spruce" or "birch":
    the class that they replace. All models of that class and state are replaced by the artist's in turn,
    ordered by name.
level
    0 (near; the default) to 3 (far). A missing level of detail falls back to the next finer one, or the
    finest.
state
    "living" (the default), or "snag": burned, without needles; of a tuft its stubble. Logs, rocks and twigs
    have one state.

Position and size of an object are normalized: its lowest point is on the ground and its origin on the axis of
the trunk. Its height becomes the height of the tree, or the diameter of a log along x. Its materials are
retained. They can read fire state and variation from the instancer attributes that `material` names.
"""

from __future__ import annotations

import functools
from collections import defaultdict
from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...errors import Error
from ...shot.shot import Shot
from . import biomes, levels, material, models, preview
from .levels import LEVELS
from .shape import Shape

ARTISTS = "Firetwin Models"
_STATES = ("living", "snag")
Look = tuple[bpy.types.Material, ...]
Kind = tuple[str, str]  # class and state


def tree_models(shot: Shot, stage: Stage, drawn: set[int] | None = None) -> bpy.types.Collection:
    """Collect all models in all levels of detail outside of the scene, indexed by `models.instance`.

    Parameters
    ----------
    drawn
        Indices of the models that are drawn; Firetwin's other models get no mesh. None: all.
    """
    looks = _looks(shot, stage)
    swapped = _artists()
    count: dict[Kind, int] = defaultdict(int)
    library, leaves = owned.library("Tree Models"), biomes.choose(shot).leaves
    nothing: bpy.types.Mesh | None = None
    for k, model in enumerate(models.every()):
        theirs, turn = swapped.get((model.kind, model.state)), count[model.kind, model.state]
        count[model.kind, model.state] += 1
        for level in range(LEVELS):
            name = f"Tree {k:02d} {level}"
            if theirs:
                data = _of_level(theirs, level, turn)
            elif drawn is None or int(models.instance(np.array(k), np.array(level))) in drawn:
                data = _mesh(name, model.in_season(level, leaves), looks(model))
            else:
                data = nothing = nothing or bpy.data.meshes.new("Firetwin No Tree")
            owned.add(library, name, data)
    return library


def _looks(shot: Shot, stage: Stage) -> Callable[[models.TreeModel], Look]:
    """Materials of leaves and wood of the models, each created on first use."""
    makers: dict[str, Callable[[Shot, Stage], bpy.types.Material]] = {
        "leaf": material.foliage,
        "wood": functools.partial(material.bark, charred=False),
        "char": functools.partial(material.bark, charred=True),
        "stone": material.rock,
        "straw": material.grass,
    }
    kinds = {"rock": ("stone", "stone"), "tuft": ("straw", "wood")}

    @functools.cache
    def made(name: str) -> bpy.types.Material:
        return makers[name](shot, stage)

    def look(model: models.TreeModel) -> Look:
        both = ("char", "char") if model.state == "snag" else kinds.get(model.kind, ("leaf", "wood"))
        return tuple(made(name) for name in both)

    return look


def drawn(points: dict[str, NDArray]) -> set[int]:
    """Return the model indices of these points, burned or not, as renders and the viewport draw them."""
    model, level = np.divmod(np.unique(np.concatenate([points["model"], points["snag_model"]])), LEVELS)
    coarse = models.instance(model, np.maximum(level, preview.LEVEL))
    return {*models.instance(model, level).tolist(), *coarse.tolist()}


def grass_models(shot: Shot, stage: Stage) -> bpy.types.Collection:
    """Collect all models of grass outside of the scene, in the order of their indices."""
    straw = material.grass(shot, stage)
    library = owned.library("Grass Models")
    for k, shape in enumerate(models.clumps()):
        owned.add(library, f"Grass {k:02d}", _mesh(f"Grass {k:02d}", shape, (straw,)))
    return library


def levelled(shot: Shot, points: dict[str, NDArray], wider: float = 1.0) -> dict[str, NDArray]:
    """Points of trees with the level of detail that the shot's nearest camera needs.

    The level is constant during the shot, so no shape changes while it is visible. Plants `wider` than trees
    of their height take the level of trees that are taller by this factor.
    """
    lens, plain = (1.0 / size for size in shot.pixel)
    near = lens / np.maximum(shot.visibility.lod_distance(points["position"]), 1.0)
    level = levels.level(wider * points["scale"] * np.maximum(near, plain))
    return {**points, **{key: models.instance(points[key], level) for key in ("model", "snag_model")}}


def _mesh(name: str, shape: Shape, look: Look) -> bpy.types.Mesh:
    points, triangles, materials, colours = shape.mesh()
    data = create_mesh(f"Firetwin {name}", points, triangles, material_index=materials)
    rgba = np.pad(colours, [(0, 0), (0, 1)], constant_values=1.0)
    add_attribute(data, "leaf", "FLOAT_COLOR", rgba)
    for each in look:
        data.materials.append(each)
    return data


def _artists() -> dict[Kind, dict[int, list[bpy.types.Mesh]]]:
    """Copy an artist's models by class and state and by level, a metre tall.

    Raises
    ------
    Error
        An object's property has an unknown value.
    """
    models_of: dict[Kind, dict[int, list[bpy.types.Mesh]]] = defaultdict(lambda: defaultdict(list))
    collection = bpy.data.collections.get(ARTISTS)
    objects = collection.all_objects if collection is not None else ()
    for obj in sorted(objects, key=lambda obj: obj.name):
        if "class" in obj:
            kind, state, level = obj["class"], obj.get("state", "living"), obj.get("level", 0)
            _check(obj.name, "class", kind, models.KINDS)
            _check(obj.name, "state", state, _STATES)
            _check(obj.name, "level", level, range(LEVELS))
            models_of[kind, state][level].append(_copy(obj))
    return models_of


def _check(name: str, key: str, value: object, known: tuple[str, ...] | range) -> None:
    if value not in known:
        raise Error(
            f'the object "{name}" in the collection "{ARTISTS}": its property {key} is {value!r}; '
            f"known are {', '.join(map(str, known))}"
        )


def _copy(obj: bpy.types.Object) -> bpy.types.Mesh:
    """Copy an artist's object as evaluated to a mesh on the ground, a metre tall.

    Raises
    ------
    Error
        It has no surface, or no height.
    """
    graph = bpy.context.evaluated_depsgraph_get()
    evaluated = obj.evaluated_get(graph)
    try:
        data = bpy.data.meshes.new_from_object(evaluated, preserve_all_data_layers=True, depsgraph=graph)
    except RuntimeError:
        data = None
    points = np.empty((0 if data is None else len(data.vertices), 3), np.float32)
    if len(points):
        data.vertices.foreach_get("co", points.ravel())
        turn = np.array(obj.matrix_world.to_3x3(), np.float32)
        points = points @ turn.T
    height = float(np.ptp(points[:, 2])) if len(points) else 0.0
    if height <= 0.0:
        raise Error(
            f'the object "{obj.name}" in the collection "{ARTISTS}" has no height; scale it, or take it out'
        )
    points[:, 2] -= points[:, 2].min()
    data.vertices.foreach_set("co", (points / height).ravel())
    data.update()
    return owned.mark(data)


def _of_level(theirs: dict[int, list[bpy.types.Mesh]], level: int, turn: int) -> bpy.types.Mesh:
    """Choose the artist's model of this turn in this level, or the next finer level, or else the finest."""
    finer = [known for known in theirs if known <= level]
    meshes = theirs[max(finer) if finer else min(theirs)]
    return meshes[turn % len(meshes)]
