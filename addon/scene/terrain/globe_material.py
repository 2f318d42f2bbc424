"""Material of the globe: the user's picture of the Earth, else a plain colour, lit by the sun at its time."""

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
_NEAR = 400_000.0  # m from the fire within which the sky has the time of day of the fire
_FAR = 30_000.0, 150_000.0  # m from the camera between which the apron's procedural land fades
_RIM, _TIGHT = (
    (0.25, 1.0),
    (0.02, 0.45),
)  # shares at which the globe's look begins and is complete: near and far
_BARE = 0.5  # between crowns and bare ground, for the temperature


def build(shot: Shot, stage: Stage, image: bpy.types.Image | None) -> bpy.types.Material:
    """Build "Firetwin Globe"."""
    material, tree = nodes.material("Firetwin Globe", PLAIN)
    here = curved_air.earth(stage)
    assert here is not None  # set before the terrain is built
    geometry = tree.node("ShaderNodeNewGeometry")
    place = tree.pick(geometry, "Position")
    day = _daylight(tree, here, place)
    tone = tree.combine(day, day, day)
    colour = tree.mix_colour(1.0, earth_colour(tree, here, image, place), tone, "MULTIPLY")
    ground = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Roughness": 0.6})
    part, air = haze.fraction(tree, stage)
    lit = tree.mix_shader(part, ground, tree.emission(tree.vector("MULTIPLY", air, tone), 1.0))
    warm = temperature.unburned_temperature(tree, shot, stage, 0.0, tree.pick(geometry, "Normal"), _BARE)
    own = infrared.surface_radiance(tree, shot, stage, warm, infrared.GROUND)
    shader = nodes.thermal_switch(tree, lit, infrared.radiance_at_camera(tree, shot, stage, own))
    tree.surface(nodes.mask_switch(tree, shader, float(masks.GROUND)))
    light.animate_sun(tree.node_tree, *light.light_keyframes(shot.full))
    return material


def blend_with_globe(
    tree: Tree, stage: Stage, image: bpy.types.Image | None, share: str, ground: Value
) -> Value:
    """Mix the ground's shader with the globe's towards the border, where the point attribute `share` is 1.

    Procedural land of the apron is coarser farther out. From afar this is visible, so less of it is retained.
    """
    here = curved_air.earth(stage)
    if here is None:
        return ground
    place = tree.output("ShaderNodeNewGeometry", name="Position")
    outward = tree.attribute(share)
    high = tree.output("ShaderNodeCameraData", name="View Distance").smoothstep(*_FAR)
    part = tree.mix(high, outward.smoothstep(*_RIM), outward.smoothstep(*_TIGHT))
    inputs = {"Color": earth_colour(tree, here, image, place), "Roughness": 0.6}
    globe = tree.output("ShaderNodeBsdfDiffuse", inputs)
    return tree.mix_shader(part, ground, globe)


def earth_colour(tree: Tree, here: Earth, image: bpy.types.Image | None, place: Value) -> Value:
    """Return the Earth's colour: its picture, by latitude and longitude of the ellipsoid's normal."""
    if image is None:
        return tree.input(
            "Globe Colour", PLAIN, "Colour of the Earth beyond the terrain, without a picture", "Globe"
        )
    normal, _ = here.upward(tree, here.scaled(tree, place))
    at = tree.vector("MULTIPLY", normal, (1.0, -1.0, 1.0))  # environment textures are seen from inside
    return tree.output("ShaderNodeTexEnvironment", {"Vector": at}, image=image)


def _daylight(tree: Tree, here: Earth, place: Value) -> Value:
    """Return daylight 0 to 1; it is 1 near the fire, since its light already follows the time of day."""
    sun = tree.node("ShaderNodeCombineXYZ")
    sun.name = space_sky.SUN
    _, up = here.upward(tree, here.scaled(tree, place))
    far = tree.vector("LENGTH", place, name="Value") * (1.0 / _NEAR)
    return tree.mix((-(far * far)).exp(), curved_air.daylight(tree, up, tree.pick(sun)), 1.0)
