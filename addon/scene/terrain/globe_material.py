"""Material of the globe: a picture of the Earth, the user's or the default, lit by the sun at its time.

The default picture shows all water in one blue (`data/earth.py`), by which the material recognises it: water
reflects the sun and the sky. Between its pixels land has noise, since 7 km are blurred from 200 km above.
"""

from __future__ import annotations

import bpy

from ...blender import nodes
from ...blender.nodes import Tree, Value
from ...blender.owned import Stage
from ...passes import masks
from ...shot.shot import Shot
from .. import curved_air, haze, infrared, space_sky, temperature
from ..curved_air import Earth
from ..light import build as light

_VIEW = (0.052, 0.072, 0.092)  # colour in Blender's solid view
_WATER = 2.0, 5.0  # ratios of blue to red in the default picture at which water begins and is complete
_WAVES = 0.28  # roughness: slopes of the sea at 5 to 10 m/s of wind (Cox and Munk 1954)
_LAND, _DARK = 0.8, (0.006, 0.008, 0.004)  # reflectance / value of the picture, plus the least; by eye
_DETAIL, _GRAIN = 18_000.0, 0.55  # m, largest wave of the noise on land; its amplitude (by eye)
_FINE = 200_000.0, 900_000.0  # m from the camera over which this noise, finer than pixels, fades
_NEAR = 400_000.0  # m from the fire within which the sky has the time of day of the fire
_FAR = 30_000.0, 150_000.0  # m from the camera between which the apron's procedural land fades
_RIM, _TIGHT = (0.25, 1.0), (0.0, 0.25)  # shares at which the globe begins and is complete: near and far
_WASH = 0.7  # share of the globe within the run, from afar: it has the colours of the land around (by eye)
_BARE = 0.5  # between crowns and bare ground, for the temperature


def build(shot: Shot, stage: Stage, image: bpy.types.Image) -> bpy.types.Material:
    """Build "Firetwin Globe"."""
    material, tree = nodes.material("Firetwin Globe", _VIEW)
    here = curved_air.earth(stage)
    assert here is not None  # set before the terrain is built
    geometry = tree.node("ShaderNodeNewGeometry")
    place = tree.pick(geometry, "Position")
    day = _daylight(tree, here, place)
    tone = tree.combine(day, day, day)
    ground = earth_shader(tree, shot, here, image, place, tone)
    part, air = haze.fraction(tree, stage)
    lit = tree.mix_shader(part, ground, tree.emission(tree.vector("MULTIPLY", air, tone), 1.0))
    warm = temperature.unburned_temperature(tree, shot, stage, 0.0, tree.pick(geometry, "Normal"), _BARE)
    own = infrared.surface_radiance(tree, shot, stage, warm, infrared.GROUND)
    shader = nodes.thermal_switch(tree, lit, infrared.radiance_at_camera(tree, shot, stage, own))
    tree.surface(nodes.mask_switch(tree, shader, float(masks.GROUND)))
    light.animate_sun(tree.node_tree, *light.light_keyframes(shot.full))
    return material


def blend_with_globe(
    tree: Tree, shot: Shot, stage: Stage, image: bpy.types.Image, share: str, ground: Value, burned: Value
) -> Value:
    """Mix the ground's shader with the globe's towards the border, where the point attribute `share` is 1.

    Procedural land of the apron is coarser farther out. From afar this is visible, so less of it is retained,
    and all unburned ground takes a part of the globe's colour.
    """
    here = curved_air.earth(stage)
    if here is None:
        return ground
    place = tree.output("ShaderNodeNewGeometry", name="Position")
    outward = tree.attribute(share)
    high = tree.output("ShaderNodeCameraData", name="View Distance").smoothstep(*_FAR)
    wash = (1.0 - burned) * _WASH
    far = wash + outward.smoothstep(*_TIGHT) * (1.0 - wash)
    part = tree.mix(high, outward.smoothstep(*_RIM), far)
    globe = earth_shader(tree, shot, here, image, place, (1.0, 1.0, 1.0))
    return tree.mix_shader(part, ground, globe)


def earth_shader(
    tree: Tree, shot: Shot, here: Earth, image: bpy.types.Image, place: Value, tone: Value | tuple
) -> Value:
    """Shade the Earth by its picture, at the latitude and longitude of the ellipsoid's normal.

    Parameters
    ----------
    tone
        Factor on reflectances: daylight.
    """
    normal, up = here.upward(tree, here.scaled(tree, place))
    at = tree.vector("MULTIPLY", normal, (1.0, -1.0, 1.0))  # environment textures are seen from inside
    shown = tree.output("ShaderNodeTexEnvironment", {"Vector": at}, image=image)
    if shot.settings.terrain.globe is not None:
        return _diffuse(tree, tree.mix_colour(1.0, shown, tone, "MULTIPLY"))
    red, _, blue = tree.separate(shown)
    water = tree.math("DIVIDE", blue, red + 1e-4).smoothstep(*_WATER)
    grain = tree.noise(place, _DETAIL, 5.0, 0.6).ramp(
        0.2, 0.8, _LAND * (1.0 - _GRAIN), _LAND * (1.0 + _GRAIN)
    )
    land = tree.vector("ADD", tree.vector("MULTIPLY", shown, tree.combine(grain, grain, grain)), _DARK)
    colour = tree.mix_colour(water, land, shown)
    matte = _diffuse(tree, tree.mix_colour(1.0, colour, tone, "MULTIPLY"))
    inputs = {"Color": tone, "Roughness": _WAVES, "Normal": up}
    mirror = tree.output("ShaderNodeBsdfGlossy", inputs)
    part = tree.output("ShaderNodeFresnel", {"IOR": 1.33, "Normal": up}) * water
    return tree.mix_shader(part, matte, mirror)


def _diffuse(tree: Tree, colour: Value) -> Value:
    return tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Roughness": 0.6})


def _daylight(tree: Tree, here: Earth, place: Value) -> Value:
    """Return daylight 0 to 1; it is 1 near the fire, since its light already follows the time of day."""
    sun = tree.node("ShaderNodeCombineXYZ")
    sun.name = space_sky.SUN
    _, up = here.upward(tree, here.scaled(tree, place))
    far = tree.vector("LENGTH", place, name="Value") * (1.0 / _NEAR)
    return tree.mix((-(far * far)).exp(), curved_air.daylight(tree, up, tree.pick(sun)), 1.0)
