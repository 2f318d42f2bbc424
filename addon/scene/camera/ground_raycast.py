"""Ground raycast: terrain height below cameras, and the point that they look at, on the terrain mesh."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import ArrayLike, NDArray

from ...blender import owned
from ...blender.owned import Stage

# of the film's scene and of the live scene, of which one is hidden
_GROUNDS = f"{owned.ROOT} Ground", f"{owned.ROOT} Live Ground"
_SKY = 50_000.0  # m, above any terrain


def terrain_height(stage: Stage, place: Sequence[float] | NDArray[np.float64]) -> float | None:
    """Return the terrain's scene z at a point (2 or 3,); None without terrain there."""
    east, north = float(place[0]), float(place[1])
    met = cast_ray(stage, (east, north, _SKY), (0.0, 0.0, -1.0))
    return None if met is None else met.z


def height_above_terrain(stage: Stage, places: NDArray[np.float64]) -> float:
    """Return the least height (m) of points (n, 3) above the terrain, at least 0; 0 without terrain."""
    heights = [float(place[2]) - z for place in places if (z := terrain_height(stage, place)) is not None]
    return max(min(heights), 0.0) if len(heights) else 0.0


def cast_ray(stage: Stage, origin: ArrayLike, direction: ArrayLike) -> Vector | None:
    """Intersect a ray in the scene with the terrain that 3D views show; None without an intersection."""
    layer = stage.scene.view_layers[0]
    grounds = [obj for obj in stage.root.all_objects if _is_terrain(obj)]
    if not grounds:
        return None
    ground = next((obj for obj in grounds if obj.visible_get(view_layer=layer)), grounds[0])
    inverse = ground.matrix_world.inverted()
    start = inverse @ Vector(origin)
    way = (inverse.to_3x3() @ Vector(direction)).normalized()

    def meet() -> tuple[bool, Vector]:
        return ground.evaluated_get(layer.depsgraph).ray_cast(start, way, distance=1.0e6)[:2]

    try:
        found, where = meet()
    # a window may show another view layer, or may not have evaluated the scene yet
    except (TypeError, RuntimeError):
        layer.update()
        found, where = meet()
    return ground.matrix_world @ where if found else None


def clearance_offset(stage: Stage, place: Sequence[float] | NDArray[np.float64], clearance: float) -> float:
    """Return the upward offset (m) that puts a point (3,) at least `clearance` above the terrain."""
    ground = terrain_height(stage, place)
    return 0.0 if ground is None else float(max(ground + clearance - np.asarray(place)[2], 0.0))


def _is_terrain(obj: bpy.types.Object) -> bool:
    return obj.type == "MESH" and owned.is_ours(obj) and obj.get(owned.NAME) in _GROUNDS
