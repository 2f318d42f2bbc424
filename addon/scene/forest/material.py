"""Materials of trees: leaves that live, torch, scorch and char, bark, rock, and grass.

Variation between trees comes from attributes of the instancer: `arrival_time` (s), `tint`, `hue`, `dead`,
`scorch` (scorch height over tree height, 0..1), `torched` (1: the crown burns), `elevation` (m). Variation
within a tree is in the mesh's colour attribute `leaf`.
"""

from __future__ import annotations

import bpy

from ...blender import nodes
from ...blender.owned import Stage
from ...passes import masks
from ...shot.fire import heat_release
from ...shot.shot import Shot
from .. import cell_distances, flame_field, granite, haze, infrared, temperature
from ..glow import CLOSE, EMBER, FAR, FLAME, FLAMING_TIME, brightness
from . import biomes

TINTS = (0.56, 0.64, 0.70), (1.48, 1.34, 1.15)
"""Factors on the colour of the bluest and of the yellowest trees."""
TORCHING = 300.0  # s that a crown is in flames; it is gone afterwards
_BUSH = 0.3  # fraction of that time of a bush amid grass (assumed)
_TORCH = 0.1, 0.9  # factor of the flames' radiance at the distances CLOSE: crowns close by fill whole pixels
_BETWEEN = 0.0, 0.9  # factor for flames between crowns: gaps are not resolved far away; by eye
_TONGUES = 0.3  # ratio of width to height of flames in crowns
_DEAD = 0.03  # fraction of trees that died before the fire
_HEATED, _CHARRED, _KILLED = (-10.0, 4.0), (2.0, 20.0), (5.0, 60.0)
"""s after the front's arrival between which needles of a burning crown turn brown, then black, and needles
that heat kills turn brown (assumed)."""
LOW_BARE_AFTER = 0.1, 0.5
"""Times from the fire to a bare bush or tuft, over the time that bushes are in flames: thin fuel goes first
(by eye)."""
BARE_AFTER = 6.0, 30.0  # s from the fire to a crown without needles, within the field of flames (assumed)
_STRESSED = 0.07  # fraction of trees whose tops are yellow and brown from drought or insects; by eye
_YELLOWED = (0.110, 0.098, 0.036)
_HUES = (0.64, 0.80, 0.98), (1.46, 1.24, 0.88)  # factors on the bluest and yellowest stands; by eye
_COAL, _COAL_LIGHT = (1.0, 0.20, 0.016), 0.22  # colour, and radiance at exposure 0 (by eye)
_COALS, _COALS_LAST = 0.4, (200.0, 3600.0)  # fraction of burned trunks and logs; s, decay to 1/e (assumed)
_COALS_UP, _COALS_SEEN = 0.08, (100.0, 250.0)  # tree heights; m from the camera
_SINGED = 0.7  # browning of the green tops of partly scorched trees by hot air and soot; by eye
_BROWN = ((0.060, 0.041, 0.026), (0.118, 0.080, 0.046))  # needles killed by drought, beetles or heat
_REFLECTED = (0.04, 0.045, 0.025)  # colour of plants that light other surfaces, a mean (assumed)
_BLACK = ((0.010, 0.008, 0.007), (0.030, 0.024, 0.020))  # charred needles


def foliage(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Foliage"."""
    material, tree = nodes.material("Firetwin Foliage", (0.16, 0.32, 0.10))
    tint = tree.attribute("tint", "INSTANCER")
    leaf = tree.attribute("leaf", output="Color")
    cool = tree.input("Cool Tint", TINTS[0], "Factor on the bluest trees' colour", "Variety")
    warm = tree.input("Warm Tint", TINTS[1], "Factor on the yellowest trees' colour", "Variety")
    lost = tree.input("Dead Share", _DEAD, "Part of the trees that was brown before", "Variety", most=1.0)
    hue = tree.mix_colour(tree.attribute("hue", "INSTANCER"), *_HUES)
    varied = tree.mix_colour(1.0, tree.mix_colour(tint, cool, warm), hue, "MULTIPLY")
    green = tree.mix_colour(1.0, leaf, varied, "MULTIPLY")
    brown = tree.mix_colour(tint, *_shades(tree, "Scorched", _BROWN, "needles killed by drought or heat"))
    place = _place(tree)
    ill = tree.input("Stressed Share", _STRESSED, "Part of the trees with brown tops", "Variety", most=1.0)
    ill = tree.attribute("dead", "INSTANCER") < lost + ill
    top = tree.separate(place)[2].smoothstep(0.35, 0.95) * ill
    pale = tree.mix_colour(top * 0.8, green, tree.mix_colour(0.35, _YELLOWED, brown))
    living = tree.mix_colour(tree.attribute("dead", "INSTANCER") < lost, pale, brown)
    torched, age = tree.attribute("torched", "INSTANCER"), _age(tree)
    killed = age.smoothstep(*_KILLED)
    reach = tree.attribute("scorch", "INSTANCER") * 1.16 - 0.08  # over the whole crown where scorch is 1
    scorched = tree.separate(place)[2].smoothstep(reach + 0.08, reach - 0.08)
    # Scorch varies: some crowns stay green next to brown ones.
    hot = tree.attribute("scorch", "INSTANCER") - tree.attribute("dead", "INSTANCER") * 0.35
    singed = hot.smoothstep(0.05, 0.35) * tree.input(
        "Singed", _SINGED, "How brown the tops of scorched trees are", "Variety", most=1.0
    )
    spared = tree.mix_colour(tree.math("MAXIMUM", scorched, singed) * killed, living, brown)
    charred = _shades(tree, "Charred", _BLACK, "needles that burned")
    black = tree.mix_colour(tree.attribute("dead", "INSTANCER"), *charred)
    browned = tree.mix_colour(age.smoothstep(*_HEATED), living, brown)
    burned = tree.mix_colour(age.smoothstep(*_CHARRED), browned, black)
    colour = tree.mix_colour(torched, spared, burned)
    _leaves(tree, shot, stage, colour, _rounded(tree, place), torched)
    material.cycles.emission_sampling = "NONE"
    return material


def bark(shot: Shot, stage: Stage, *, charred: bool) -> bpy.types.Material:
    """Build "Firetwin Bark", or the char of snags."""
    name, shown = ("Snag", (0.05, 0.05, 0.05)) if charred else ("Bark", (0.12, 0.08, 0.05))
    material, tree = nodes.material(f"Firetwin {name}", shown)
    material.cycles.emission_sampling = "NONE"
    tint = tree.attribute("tint", "INSTANCER")
    char = ((0.009, 0.008, 0.008), (0.030, 0.027, 0.025))
    black = tree.mix_colour(tint, *_shades(tree, "Charred", char, "charred bark"))
    age = _age(tree)
    if charred:
        colour = black
    else:
        wood = tree.attribute("leaf", output="Color")
        brown = tree.mix_colour(
            1.0, wood, tree.mix_colour(tint, (0.7, 0.7, 0.7), (1.2, 1.2, 1.2)), "MULTIPLY"
        )
        low = tree.separate(_place(tree))[2].smoothstep(0.5, 0.3)  # flames of a surface fire char the base
        whole = tree.attribute("torched", "INSTANCER")
        burned = age.smoothstep(*_CHARRED) * tree.math("MAXIMUM", low, whole)
        colour = tree.mix_colour(burned, brown, black)
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})
    burning, glow = _smouldering(tree, shot, tint, age)
    normal = tree.output("ShaderNodeNewGeometry", name="Normal")
    warmth = _warmth(tree, shot, stage, normal, age, age > 0.0)
    _finish(tree, shot, stage, tree.add_shader(matt, burning), warmth, glow=glow)
    return material


def _smouldering(
    tree: nodes.Tree, shot: Shot, tint: nodes.Value, age: nodes.Value
) -> tuple[nodes.Value, nodes.Value]:
    """Return shader and radiance of coals at the foot of some burned trunks, and on some logs.

    They are near the camera; elsewhere the shader is not evaluated.
    """
    chance, lasts = (tree.math("FRACT", tint * factor) for factor in (71.0, 713.0))
    since = tree.math("MAXIMUM", age, 0.0)
    fading = (since / tree.math("POWER", _COALS_LAST[1] / _COALS_LAST[0], lasts) / -_COALS_LAST[0]).exp()
    tall = tree.separate(tree.attribute("number", "INSTANCER", "Vector"))[0] > 0.0
    low = tree.separate(_place(tree))[2].smoothstep(tree.mix(tall, 1.2, _COALS_UP), 0.0)
    near = tree.output("ShaderNodeCameraData", name="View Distance").ramp(*_COALS_SEEN, 1.0, 0.0)
    alight = low * fading * near * (age > 0.0) * (chance < _COALS)
    alight = alight * (alight > 0.03)
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    cracks = tree.noise(tree.vector("MULTIPLY", position, (1.0, 1.0, 0.4)), 0.25, 3.0).smoothstep(0.52, 0.66)
    bright = tree.input(
        "Coal Brightness",
        _COAL_LIGHT if shot.settings.fire.embers else 0.0,
        "Radiance of coals on burned wood, at exposure 0",
        "Fire",
    )
    shader = tree.output("ShaderNodeMixShader", {0: alight, 2: tree.emission(_COAL, cracks * bright)})
    power = alight * cracks * bright
    return shader, tree.vector("MULTIPLY", _COAL, tree.combine(power, power, power))


def rock(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Rock": the ground's granite, varied between rocks, with soot where it burned."""
    material, tree = nodes.material("Firetwin Rock", (0.32, 0.31, 0.29))
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    tint, age = tree.attribute("tint", "INSTANCER"), _age(tree)
    stone, height = granite.face(tree, position, granite.pixel_size(shot, distance))
    stone = tree.mix_colour(
        1.0, stone, tree.mix_colour(tint, (0.46, 0.44, 0.40), (0.95, 0.94, 0.90)), "MULTIPLY"
    )
    licks = tree.noise(position, 0.5, 3.0)  # flames blacken the stone in tongues from the ground
    soot = (tree.separate(_place(tree))[2] + licks - 0.5).smoothstep(1.1, 0.1) * age.smoothstep(*_CHARRED)
    colour = tree.mix_colour(soot * 0.85, stone, (0.022, 0.020, 0.019))
    normal = tree.output("ShaderNodeBump", {"Strength": 0.8, "Distance": 1.0, "Height": height})
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Roughness": 0.6, "Normal": normal})
    elevation = tree.attribute("elevation", "INSTANCER")
    ambient = temperature.unburned_temperature(tree, shot, stage, elevation, normal, 1.0)
    warmth = infrared.surface_radiance(tree, shot, stage, ambient, infrared.STONE)
    _finish(tree, shot, stage, matt, warmth)
    material.cycles.emission_sampling = "NONE"
    return material


def grass(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Grass": cured in September, burned to the ground by the fire."""
    material, tree = nodes.material("Firetwin Grass", (0.42, 0.38, 0.16))
    tint = tree.attribute("tint", "INSTANCER")
    here = biomes.choose(shot)
    straw = tree.input("Dry Colour", here.biome.grass[0], "Colour of dry grass", "Variety")
    green = tree.input("Green Colour", here.biome.grass[1], "Colour of green grass", "Variety")
    if here.biome.open_land is not None:
        tint = (tint + 2.0 * here.green - 1.0).clamp()
    dry = tree.mix_colour(tint, straw, green)
    black = tree.mix_colour(tint, *_shades(tree, "Charred", _BLACK, "grass that burned"))
    colour = tree.mix_colour(_age(tree).smoothstep(*_CHARRED), dry, black)
    normal = tree.output("ShaderNodeNewGeometry", name="Normal")
    _leaves(tree, shot, stage, colour, normal, 1.0)
    material.cycles.emission_sampling = "NONE"
    return material


def _shades(
    tree: nodes.Tree, name: str, colours: tuple[tuple[float, ...], ...], what: str
) -> tuple[nodes.Value, nodes.Value]:
    """Input sockets for the darkest and the lightest colour."""
    dark, light = colours
    return (
        tree.input(f"{name} Dark", dark, f"Darkest of {what}", "Scar"),
        tree.input(f"{name} Light", light, f"Lightest of {what}", "Scar"),
    )


def _age(tree: nodes.Tree) -> nodes.Value:
    return nodes.model_time(tree) - tree.attribute("arrival_time", "INSTANCER")


def _place(tree: nodes.Tree) -> nodes.Value:
    """Position in a tree, in tree heights."""
    return tree.output(
        "ShaderNodeVectorTransform",
        [tree.output("ShaderNodeNewGeometry", name="Position")],
        vector_type="POINT",
        convert_from="WORLD",
        convert_to="OBJECT",
    )


def _rounded(tree: nodes.Tree, place: nodes.Value) -> nodes.Value:
    """Point normals away from the trunk, which gives a crown a sunlit and a shaded side."""
    x, y, z = tree.separate(place)
    radial = tree.output(
        "ShaderNodeVectorTransform",
        [tree.vector("NORMALIZE", tree.combine(x, y, 0.05 + z * 0.04))],
        vector_type="VECTOR",
        convert_from="OBJECT",
        convert_to="WORLD",
    )
    facing = tree.vector("NORMALIZE", radial)
    normal = tree.output("ShaderNodeNewGeometry", name="Normal")
    own = tree.vector("MULTIPLY", normal, (0.55, 0.55, 0.55))
    return tree.vector("NORMALIZE", tree.vector("ADD", facing, own))


def _short(shot: Shot) -> float:
    """Return the ratio of the burning time of the shot's surface fuel to the burning time of timber."""
    return min(shot.fire.smoke.residence / heat_release.FLAMING, 1.0)


def burning_share(shot: Shot) -> float:
    """Return the ratio of the time that bushes are in flames to `TORCHING`."""
    return max(_short(shot), _BUSH)


def _leaves(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    colour: nodes.Value,
    normal: nodes.Value,
    torched: nodes.Value | float,
) -> None:
    """Finish a leaf material of this colour; it burns where `torched` is 1.

    Distant trees are few and wide and hide the ground, so they also carry the flames of the ground between
    them.
    """
    age = _age(tree)
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Normal": normal})
    through = tree.output("ShaderNodeBsdfTranslucent", {"Color": colour, "Normal": normal})
    clear = tree.input("Translucency", 0.35, "Part of the light that goes through leaves", "Leaves", most=1.0)
    leaf = tree.mix_shader(clear, matt, through)
    x, y, z = tree.separate(tree.output("ShaderNodeNewGeometry", name="Position"))
    flicker = tree.noise(tree.combine(x, y, (z - age * 6.0) * _TONGUES), 4.0, 2.0)
    short, bush = _short(shot), burning_share(shot)
    crown = (
        age.smoothstep(0.0, 40.0 * bush) * age.smoothstep(TORCHING * bush, 0.4 * TORCHING * bush) * torched
    )
    lasts = distance.ramp(1500.0, FAR, *(short * time for time in FLAMING_TIME))
    below = age.smoothstep(0.0, 20.0 * short) * (age / lasts).smoothstep(1.0, 0.3) * (1.0 - torched)
    below = below * distance.ramp(*CLOSE, 0.0, 1.0)
    alight = (crown + below) * flame_field.share(tree, stage)
    flaming = alight * flicker.smoothstep(0.47, 0.69)
    afar = tree.mix(torched, distance.ramp(*CLOSE, *_BETWEEN), distance.ramp(*CLOSE, *_TORCH))
    ember = tree.input("Ember Colour", EMBER, "Light of a crown that glows", "Fire")
    flame = tree.input("Flame Colour", FLAME, "Light of a crown in flames", "Fire")
    bright = tree.input("Flame Brightness", brightness(shot), "Radiance of a crown in flames", "Fire")
    flame = tree.mix_colour(flaming.smoothstep(0.1, 0.8), ember, flame)
    power = flaming * afar * bright
    burning = tree.add_shader(leaf, tree.emission(flame, power))
    glow = tree.vector("MULTIPLY", flame, tree.combine(power, power, power))
    warmth = _warmth(tree, shot, stage, normal, age, 0.0)
    hot = flaming.ramp(0.0, 1.0, temperature.FLAME_LOW, temperature.FLAME_HIGH)
    hot = infrared.surface_radiance(tree, shot, stage, hot)
    warmth = tree.mix(flaming, warmth, hot)
    _finish(tree, shot, stage, burning, warmth, alight, glow)


def _warmth(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    normal: nodes.Value,
    age: nodes.Value,
    burned: nodes.Value | float,
) -> nodes.Value:
    """Infrared radiance of leaves and wood, before the atmosphere; leaves that have `burned` cool at once."""
    elevation = tree.attribute("elevation", "INSTANCER")
    ambient = temperature.unburned_temperature(tree, shot, stage, elevation, normal, 0.0)
    kelvin = temperature.burned_temperature(tree, ambient, age, burned)
    return infrared.surface_radiance(tree, shot, stage, kelvin, infrared.NEEDLES)


def _finish(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    shader: nodes.Value,
    warmth: nodes.Value,
    alight: nodes.Value | float = 0.0,
    glow: nodes.Value | None = None,
) -> None:
    """Finish the surface: `shader` through the haze, its infrared radiance, or its class and instance number.

    Trees have an instance number. An `alight` tree is of the class fire, also between the tongues of its
    flames, which are smaller than pixels from afar. The understorey counts as ground.

    Rays from other surfaces meet a plain shader, which takes less time and emits no light: lamps light the
    surroundings of flames.
    """
    at_camera = infrared.radiance_at_camera(tree, shot, stage, warmth)
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    plain = tree.output("ShaderNodeBsdfDiffuse", {"Color": _REFLECTED})
    shader = cell_distances.write(tree, stage, haze.apply(tree, shader, stage, glow))
    shader = tree.mix_shader(camera, plain, shader)
    shader = nodes.thermal_switch(tree, shader, at_camera)
    # Not "Fac", the mean of three equal components: it is rounded, and instance numbers need all 24 bits.
    number, _, _ = tree.separate(tree.attribute("number", "INSTANCER", "Vector"))
    below = (_age(tree) > 0.0) * (masks.BURNED - masks.GROUND) + masks.GROUND
    kind = tree.mix(number > 0.0, below, float(masks.TREE))
    if isinstance(alight, nodes.Value):
        kind = tree.mix(alight > masks.ALIGHT, kind, float(masks.FIRE))
    tree.surface(nodes.mask_switch(tree, shader, kind, number))
