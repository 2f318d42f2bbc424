"""Material of the globe: the user's picture of the Earth, else one plain colour, in the light of its hour."""

from __future__ import annotations

import bpy

from ...blender import nodes
from ...blender.nodes import Tree, Value
from ...blender.owned import Stage
from ...shot.passes import masks
from ...shot.shot import Shot
from .. import curved_air, haze, infrared, space_sky, temperature
from ..curved_air import Earth
from ..light import build as light

PLAIN = (0.052, 0.072, 0.092)
"""Reflectance without a picture: neither land nor sea; as bright as forest from above. By eye."""
_NEAR = 400_000.0  # m from the fire within which the sky's light is that of the fire's hour
_FAR = 30_000.0, 150_000.0  # m from the camera between which the apron's invented land goes
_RIM, _TIGHT = (
    (0.25, 1.0),
    (0.02, 0.45),
)  # shares where its look begins and is whole: near and far
_BARE = 0.5  # between crowns and bare ground, for the temperature


def build(shot: Shot, stage: Stage, image: bpy.types.Image | None) -> bpy.types.Material:
    """Build "Firetwin Globe"."""
    material, tree = nodes.material("Firetwin Globe", PLAIN)
    here = curved_air.earth(stage)
    assert here is not None  # set before the terrain is built
    geometry = tree.node("ShaderNodeNewGeometry")
    place = tree.pick(geometry, "Position")
    day = _day(tree, shot, here, place)
    tone = tree.combine(day, day, day)
    colour = tree.mix_colour(1.0, seen(tree, here, image, place), tone, "MULTIPLY")
    ground = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Roughness": 0.6})
    part, air = haze.fraction(tree, stage)
    lit = tree.mix_shader(part, ground, tree.emission(tree.vector("MULTIPLY", air, tone), 1.0))
    warm = temperature.unburned_temperature(tree, shot, stage, 0.0, tree.pick(geometry, "Normal"), _BARE)
    own = infrared.surface_radiance(tree, shot, stage, warm, infrared.GROUND)
    shader = nodes.thermal_switch(tree, lit, infrared.radiance_at_camera(tree, shot, stage, own))
    tree.surface(nodes.mask_switch(tree, shader, float(masks.GROUND)))
    light.animate_sun(tree.node_tree, *light.light_keyframes(shot.full))
    return material


def blended(tree: Tree, stage: Stage, image: bpy.types.Image | None, share: str, ground: Value) -> Value:
    """The ground's shader; that of the globe towards the border, where the point attribute `share` is 1.

    Invented land of the apron is the coarser the farther out it is. From afar it shows, so that less of it is
    left there.
    """
    here = curved_air.earth(stage)
    if here is None:
        return ground
    place = tree.output("ShaderNodeNewGeometry", name="Position")
    outward = tree.attribute(share)
    high = tree.output("ShaderNodeCameraData", name="View Distance").smoothstep(*_FAR)
    part = tree.mix(high, outward.smoothstep(*_RIM), outward.smoothstep(*_TIGHT))
    inputs = {"Color": seen(tree, here, image, place), "Roughness": 0.6}
    globe = tree.output("ShaderNodeBsdfDiffuse", inputs)
    return tree.mix_shader(part, ground, globe)


def seen(tree: Tree, here: Earth, image: bpy.types.Image | None, place: Value) -> Value:
    """Colour of the Earth at a place: of its picture, by latitude and longitude of the ellipsoid's normal."""
    if image is None:
        return tree.input(
            "Globe Colour", PLAIN, "Of the Earth beyond the terrain, without a picture", "Globe"
        )
    normal, _ = here.upward(tree, here.scaled(tree, place))
    at = tree.vector("MULTIPLY", normal, (1.0, -1.0, 1.0))  # textures of surroundings are seen from inside
    return tree.output("ShaderNodeTexEnvironment", {"Vector": at}, image=image)


def _day(tree: Tree, shot: Shot, here: Earth, place: Value) -> Value:
    """Daylight 0 to 1; near the fire 1, as its light follows the hour already."""
    sun = tree.node("ShaderNodeCombineXYZ")
    sun.name = space_sky.SUN
    _, up = here.upward(tree, here.scaled(tree, place))
    far = tree.vector("LENGTH", place, name="Value") * (1.0 / _NEAR)
    return tree.mix((-(far * far)).exp(), curved_air.daylight(tree, up, tree.pick(sun)), 1.0)
