"""The ground that is built, as cameras meet it: how high it is under them, and where they look at it."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import ArrayLike

from ...blender import owned
from ...blender.owned import Stage

_SKY = 50_000.0  # m, over any ground


def up(stage: Stage, place: ArrayLike) -> float | None:
    """Scene z of the ground at a place (2 or 3,); None where there is none."""
    east, north = float(place[0]), float(place[1])
    met = hit(stage, (east, north, _SKY), (0.0, 0.0, -1.0))
    return None if met is None else met.z


def height(stage: Stage, places: ArrayLike) -> float:
    """The least height (m) of places (n, 3) above the ground, at least 0; 0 where there is no ground."""
    found = [place[2] - z for place in places if (z := up(stage, place)) is not None]
    return max(min(found), 0.0) if len(found) else 0.0


def hit(stage: Stage, origin: ArrayLike, direction: ArrayLike) -> Vector | None:
    """Where a ray in the scene meets the ground; None where it does not."""
    ground = next((thing for thing in stage.root.all_objects if _ground(thing)), None)
    if ground is None:
        return None
    inverse = ground.matrix_world.inverted()
    start = inverse @ Vector(origin)
    way = (inverse.to_3x3() @ Vector(direction)).normalized()
    layer = stage.scene.view_layers[0]

    def meet() -> tuple[bool, Vector]:
        return ground.evaluated_get(layer.depsgraph).ray_cast(start, way, distance=1.0e6)[:2]

    try:
        found, where = meet()
    except (TypeError, RuntimeError):  # a window may show another view layer alone, or has not drawn yet
        layer.update()
        found, where = meet()
    return ground.matrix_world @ where if found else None


def lift(stage: Stage, place: ArrayLike, clearance: float) -> float:
    """How much higher (m) a place (3,) must be for the ground to stay `clearance` away."""
    ground = up(stage, place)
    return 0.0 if ground is None else float(max(ground + clearance - np.asarray(place)[2], 0.0))


def _ground(thing: bpy.types.Object) -> bool:
    return thing.type == "MESH" and owned.ours(thing) and thing.get(owned.NAME) == f"{owned.ROOT} Ground"
