"""Buildings of the user's land use map: walls and flat roofs extruded from footprints, one mesh for all."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.owned import Stage
from ...shot.passes import masks
from ...shot.shot import Shot
from ...shot.terrain import land_use, noise
from .. import haze, infrared, temperature

_WALL = (0.24, 0.22, 0.19)  # linear reflectances; by eye
_ROOFS = ((0.125, 0.048, 0.030), (0.150, 0.068, 0.043), (0.075, 0.072, 0.070), (0.110, 0.100, 0.088))
_DEEP = 4.0  # m of the walls below the terrain at the centre, so that no wall ends above a slope

Array = NDArray[np.float64]


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Roofs"; None where the map has no buildings."""
    known = land_use.read_map(shot)
    houses = [feature for feature in known.features if feature.kind == "building"] if known else []
    points: list[Array] = []
    faces: list[tuple[int, ...]] = []
    colours: list[tuple[float, float, float]] = []
    for house in houses:
        for number, polygon in enumerate(house.polygons):
            lot = float(noise.uniform([house.number], 20 + number, shot.settings.seed)[0])
            colour = _ROOFS[int(lot * len(_ROOFS))]
            _add(shot, polygon[0], house.height, colour, points, faces, colours)
    if not points:
        return None
    data = bpy.data.meshes.new("Firetwin Roofs")
    data.from_pydata([tuple(p) for p in points], [], faces)
    shade = data.attributes.new("shade", "FLOAT_COLOR", "FACE")
    shade.data.foreach_set("color", np.pad(np.array(colours, np.float32), [(0, 0), (0, 1)]).ravel())
    data.materials.append(_material(shot, stage))
    data.update()
    return owned.add(stage.part("Terrain"), "Roofs", data)


def _add(
    shot: Shot, ring: Array, height: float, colour: tuple[float, float, float],
    points: list[Array], faces: list[tuple[int, ...]], colours: list[tuple[float, float, float]],
) -> None:  # fmt: skip
    """Append the walls and the roof over a footprint (n, 2), m."""
    ground = shot.ground.up(*ring.T)
    first, count = len(points), len(ring)
    low, high = float(ground.min()) - _DEEP, float(ground.mean()) + height
    points += [np.array([x, y, z]) for z in (low, high) for x, y in ring]
    for k in range(count):
        after = (k + 1) % count
        faces.append((first + k, first + after, first + count + after, first + count + k))
        colours.append(_WALL)
    for triangle in tessellate_polygon([[Vector((x, y, 0.0)) for x, y in ring]]):
        faces.append(tuple(first + count + k for k in triangle))
        colours.append(colour)


def _material(shot: Shot, stage: Stage) -> bpy.types.Material:
    material, tree = nodes.material("Firetwin Roofs", (0.3, 0.25, 0.22))
    colour = tree.attribute("shade", output="Color")
    geometry = tree.node("ShaderNodeNewGeometry")
    grain = tree.noise(tree.pick(geometry, "Position"), 1.3, 3.0).ramp(0.3, 0.7, 0.8, 1.2)
    colour = tree.mix_colour(1.0, colour, tree.combine(grain, grain, grain), "MULTIPLY")
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})
    _, _, up = tree.separate(tree.pick(geometry, "Position"))
    ambient = temperature.ambient(tree, shot, stage, up, tree.pick(geometry, "Normal"), 1.0)
    warmth = infrared.through_air(
        tree, shot, stage, infrared.emitted(tree, shot, stage, ambient, infrared.STONE)
    )
    shader = nodes.thermal_switch(tree, haze.apply(tree, matt, stage), warmth)
    tree.surface(nodes.mask_switch(tree, shader, float(masks.GROUND)))
    return material
