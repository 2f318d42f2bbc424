"""Buildings of the user's land use map: walls and flat roofs extruded from footprints, one mesh for all."""

from __future__ import annotations

from dataclasses import dataclass, field

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

WALL = (0.24, 0.22, 0.19)  # linear reflectances; by eye
_ROOFS = ((0.125, 0.048, 0.030), (0.150, 0.068, 0.043), (0.075, 0.072, 0.070), (0.110, 0.100, 0.088))
_DEEP = 4.0  # m of the walls below the terrain at the centre, so that no wall ends above a slope

Array = NDArray[np.float64]
Colour = tuple[float, float, float]


@dataclass
class Buildings:
    """Walls and roofs of several buildings: points, faces, and a colour for each face."""

    points: list[Array] = field(default_factory=list)
    faces: list[tuple[int, ...]] = field(default_factory=list)
    colours: list[Colour] = field(default_factory=list)

    def add(self, shot: Shot, ring: Array, height: float, roof: Colour, wall: Colour = WALL) -> float:
        """Append the walls and the flat roof over a footprint (n, 2), m; z of the roof."""
        ground = shot.ground.up(*ring.T)
        first, count = len(self.points), len(ring)
        low, high = float(ground.min()) - _DEEP, float(ground.mean()) + height
        self.points += [np.array([x, y, z]) for z in (low, high) for x, y in ring]
        for k in range(count):
            after = (k + 1) % count
            self.face((first + k, first + after, first + count + after, first + count + k), wall)
        for triangle in tessellate_polygon([[Vector((x, y, 0.0)) for x, y in ring]]):
            self.face(tuple(first + count + k for k in triangle), roof)
        return high

    def face(self, corners: tuple[int, ...], colour: Colour) -> None:
        """Append a face of points that are there."""
        self.faces.append(corners)
        self.colours.append(colour)

    def mesh(self, name: str, look: bpy.types.Material) -> bpy.types.Mesh:
        """All of them as one mesh, with their colours as attribute `shade`."""
        data = bpy.data.meshes.new(name)
        data.from_pydata([tuple(p) for p in self.points], [], self.faces)
        shade = data.attributes.new("shade", "FLOAT_COLOR", "FACE")
        shade.data.foreach_set("color", np.pad(np.array(self.colours, np.float32), [(0, 0), (0, 1)]).ravel())
        data.materials.append(look)
        data.update()
        return data


def build(shot: Shot, stage: Stage) -> bpy.types.Object | None:
    """Build "Firetwin Roofs"; None where the map has no buildings."""
    known = land_use.read_map(shot)
    houses = [feature for feature in known.features if feature.kind == "building"] if known else []
    made = Buildings()
    for house in houses:
        for number, polygon in enumerate(house.polygons):
            lot = float(noise.uniform([house.number], 20 + number, shot.settings.seed)[0])
            made.add(shot, polygon[0], house.height, _ROOFS[int(lot * len(_ROOFS))])
    if not made.points:
        return None
    data = made.mesh("Firetwin Roofs", material(shot, stage, "Firetwin Roofs"))
    return owned.add(stage.part("Terrain"), "Roofs", data)


def material(shot: Shot, stage: Stage, name: str) -> bpy.types.Material:
    """Material of buildings: the colour of each face with a grain, as warm as stone in air and sun."""
    look, tree = nodes.material(name, (0.3, 0.25, 0.22))
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
    return look
