"""Buildings of the user's footprints: walls and flat roofs, one mesh for all, charred where it burned."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import bpy
import numpy as np
from mathutils import Vector
from mathutils.geometry import tessellate_polygon
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...passes import masks
from ...run.buildings import Building, blocks, rings
from ...run.buildings.rings import Rings
from ...shot.shot import Shot
from ...shot.surface import footprints
from ...shot.terrain import noise
from .. import cell_distances, haze, infrared, temperature
from . import burn_scar, fields, shading_inputs, windows

WALL = (0.24, 0.22, 0.19)  # linear reflectances; by eye
_ROOFS = ((0.125, 0.048, 0.030), (0.150, 0.068, 0.043), (0.075, 0.072, 0.070), (0.110, 0.100, 0.088))
_CHARRED = 0.8  # fraction of the surface after the fire has passed (assumed)

Array = NDArray[np.float64]
Colour = tuple[float, float, float]


@dataclass
class Blocks:
    """Walls and roofs of several buildings: triangles (t, 3, 3), each with a colour and a number.

    Numbers are the instance numbers of the masks, from 1; 0 is none.
    """

    corners: list[Array] = field(default_factory=list)
    colours: list[Array] = field(default_factory=list)
    numbers: list[NDArray[np.int64]] = field(default_factory=list)
    lit: list[Array] = field(default_factory=list)  # (t, 3) colours of lit windows, black elsewhere

    def add(self, building: Building, roof: Colour, wall: Colour = WALL, number: int = 0) -> None:
        """Append a building with its outline in the scene, m."""
        corners, is_roof = blocks.block(building, triangulate)
        self.corners.append(corners)
        self.colours.append(np.where(is_roof[:, None], roof, wall))
        self.numbers.append(np.full(len(corners), number))
        self.lit.append(np.zeros((len(corners), 3)))

    def light(self, building: Building, shot: Shot, share: float, number: int = 0) -> None:
        """Append the lit windows of a building, if a `share` of all windows is lit."""
        corners, colour = windows.lit_windows(building, number, share, shot.settings.seed)
        if len(corners):
            self.corners.append(corners[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3))
            self.colours.append(np.tile(WALL, (2 * len(corners), 1)))
            self.numbers.append(np.full(2 * len(corners), number))
            self.lit.append(np.repeat(colour, 2, axis=0))

    def face(self, corners: Array, colour: Colour, number: int = 0) -> None:
        """Append a face (4, 3), anticlockwise as seen from outside."""
        self.corners.append(corners[[[0, 1, 2], [0, 2, 3]]])
        self.colours.append(np.tile(colour, (2, 1)))
        self.numbers.append(np.full(2, number))
        self.lit.append(np.zeros((2, 3)))

    def mesh(self, name: str, shot: Shot, look: bpy.types.Material) -> bpy.types.Mesh:
        """Return all faces as a single mesh.

        Its attributes: on faces `shade`, the colours, `number`, and `lit`, the light of windows, if any is
        lit; on points `elevation` and `grid`, as on the ground.
        """
        corners = np.concatenate(self.corners).reshape(-1, 3)
        data = create_mesh(name, corners, np.arange(len(corners)).reshape(-1, 3), flat=True)
        shade = np.pad(np.concatenate(self.colours), [(0, 0), (0, 1)], constant_values=1.0)
        add_attribute(data, "shade", "FLOAT_COLOR", shade, "FACE")
        lit = np.concatenate(self.lit)
        if lit.any():
            add_attribute(
                data, windows.LIT, "FLOAT_COLOR", np.pad(lit, [(0, 0), (0, 1)], constant_values=1.0), "FACE"
            )
        add_attribute(data, "number", "FLOAT", np.concatenate(self.numbers), "FACE")
        latitude, longitude, height = shot.ground.frame.reverse(corners)
        row, column = shot.ground.indices(latitude, longitude)
        add_attribute(data, "elevation", "FLOAT", height)
        place = fields.texture_coordinates(shot.ground.shape, row, column, shot.ground.fields.margin)
        add_attribute(data, fields.GRID, "FLOAT_VECTOR", place)
        data.materials.append(look)
        return data


def triangulate(outline: Rings) -> Array:
    """Triangulate a polygon with holes: triangles (t, 3, 2), anticlockwise, by Blender."""
    points = np.concatenate(outline)
    found = tessellate_polygon([[Vector((x, y, 0.0)) for x, y in ring] for ring in outline])
    return rings.anticlockwise(points[np.array(found, np.int64).reshape(-1, 3)])


def build(shot: Shot, stage: Stage, images: Mapping[str, bpy.types.Image]) -> bpy.types.Object | None:
    """Build "Firetwin Roofs" from the images of the ground's fields; None without footprints."""
    blocks, night = Blocks(), windows.shines(shot)
    share = windows.share(shot) if night else 0.0
    for building in footprints.place_buildings(shot):
        number = building.footprint.number
        lot = float(noise.uniform([number], 20, shot.settings.seed)[0])
        blocks.add(building, _ROOFS[int(lot * len(_ROOFS))], number=number + 1)
        if night:
            blocks.light(building, shot, share, number + 1)
    if not blocks.corners:
        return None
    data = blocks.mesh("Firetwin Roofs", shot, material(shot, stage, "Firetwin Roofs", images))
    return owned.add(stage.part("Terrain"), "Roofs", data)


def material(
    shot: Shot, stage: Stage, name: str, images: Mapping[str, bpy.types.Image] | None = None
) -> bpy.types.Material:
    """Build a material: the colour of each face with a grain, with stone's temperature in air and sun.

    With the `images` of the ground's fields, it is charred after the fire, and cools like the ground.
    """
    look, tree = nodes.material(name, (0.3, 0.25, 0.22))
    colour = tree.attribute("shade", output="Color")
    geometry = tree.node("ShaderNodeNewGeometry")
    grain = tree.noise(tree.pick(geometry, "Position"), 1.3, 3.0).ramp(0.3, 0.7, 0.8, 1.2)
    colour = tree.mix_colour(1.0, colour, tree.combine(grain, grain, grain), "MULTIPLY")
    _, _, up = tree.separate(tree.pick(geometry, "Position"))
    kelvin = temperature.unburned_temperature(tree, shot, stage, up, tree.pick(geometry, "Normal"), 1.0)
    emissivity = infrared.STONE
    if images:
        with tree.frame("Fire"):
            here = shading_inputs.gather(tree, fields.Fields(tree, dict(images)), shot, whole=False)
            charred = here.burned * _CHARRED
            colour = tree.mix_colour(charred, colour, burn_scar.scar_colour(tree, here))
            kelvin = temperature.burned_temperature(tree, kelvin, here.age, charred, here.residence)
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})
    if windows.shines(shot):
        with tree.frame("Windows"):
            bright = windows.strength(tree, shot)
            if images:  # burned houses are dark
                bright = bright * (1.0 - here.burned)
            matt = tree.add_shader(matt, tree.emission(tree.attribute(windows.LIT, output="Color"), bright))
        look.cycles.emission_sampling = "NONE"
    warmth = infrared.radiance_at_camera(
        tree, shot, stage, infrared.surface_radiance(tree, shot, stage, kelvin, emissivity)
    )
    visible = cell_distances.write(tree, stage, haze.apply(tree, matt, stage))
    shader = nodes.thermal_switch(tree, visible, warmth)
    number = tree.attribute("number")
    tree.surface(nodes.mask_switch(tree, shader, float(masks.BUILDING), number))
    return look
