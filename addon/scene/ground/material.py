"""Material of the ground: what grows on it, and what the fire has made of it, as a function of time.

age = model time - arrival, so one static mesh shows every minute: flames at the edge, embers, char and ash.
Reflectances are a picture's, chosen by eye against photographs, not measured.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from ...blender import nodes
from ...blender.owned import Stage
from ...shot import photo
from ...shot.passes import masks
from ...shot.shot import Shot
from .. import granite, haze
from ..glow import CLOSE, EMBER, FAR, FLAME, FLAMING_TIME
from . import fields, heat

EMBER_TIME = 3600.0  # s in which embers fade to 1/e
_CROWNS_SEEN = (5000.0, 15_000.0)  # m from the camera at which crowns are full and gone
_OWN = 1.25  # times the distance to which trees are drawn: from there on the canopy is the ground's
_JITTER = 130.0  # s; breaks the straight edges of the mesh's triangles
_FLAME_LIGHT, _EMBER_LIGHT = 10.0, 1.8  # radiance at exposure 0
_DIMMED = 0.3  # part of their light that flames of the edge have near by


@dataclass
class Place:
    """What the material knows about a point of the ground."""

    position: nodes.Value
    slope: nodes.Value  # 0 flat, 1 vertical
    canopy: nodes.Value  # kg/m2
    bare: nodes.Value  # 0..1, part of the ground nearby without fuel
    elevation: nodes.Value  # m
    distance: nodes.Value  # m from the camera
    near: nodes.Value  # 1 where trees are drawn one by one
    age: nodes.Value  # s since the fire came, negative before
    burned: nodes.Value  # 0 or 1
    pixel: nodes.Value  # m
    duff: nodes.Value  # -1..1, grain of the soil, of needles and of ash; 0 where pixels are larger


def build(
    shot: Shot,
    stage: Stage,
    images: dict[str, bpy.types.Image],
    photos: Sequence[tuple[photo.Picture, bpy.types.Image]] = (),
) -> bpy.types.Material:
    """Build "Firetwin Ground", which reads the fields of these images and is coloured by these photos."""
    material, tree = nodes.material("Firetwin Ground", (0.30, 0.26, 0.17))
    with tree.frame("Place and time"):
        known = fields.Fields(tree, images)
        place = _place(tree, known, shot)
    with tree.frame("Rock"):
        rock = _rock(tree, place)
        stone = _granite(tree, place)
    with tree.frame("What grows"):
        green, bump = _unburned(tree, place, rock, stone)
    for picture, image in photos:
        with tree.frame("Photo"):
            green, bump = _photographed(tree, place, picture, image, green, bump)
    with tree.frame("Char and ash"):
        char = _charred(tree, place, rock, stone[0])
        colour = tree.mix_colour(place.burned, green, char)
    with tree.frame("Flames and embers"):
        flaming, embers = _glow(tree, place, rock)
        light = _light(tree, shot, place, flaming, embers)
    with tree.frame("Surface"):
        normal = tree.output("ShaderNodeBump", {"Strength": 0.9, "Distance": 1.0, "Height": bump})
        matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Roughness": 0.6, "Normal": normal})
        lake = known["water"] > 0.5
        matt = tree.mix_shader(lake, matt, _water(tree, place))
        shader = haze.apply(tree, tree.add_shader(matt, light), stage)
    with tree.frame("Infrared"):
        facing = tree.output("ShaderNodeNewGeometry", name="Normal")
        warmth = heat.radiance(tree, shot, stage, place, rock, lake, facing, (flaming, embers))
    with tree.frame("Masks"):
        alight = (flaming > masks.ALIGHT) * (masks.FIRE - masks.BURNED)
        kind = place.burned * (alight + (masks.BURNED - masks.GROUND)) + masks.GROUND
    tree.surface(nodes.mask_switch(tree, nodes.thermal_switch(tree, shader, warmth), kind))
    material.cycles.emission_sampling = "NONE"  # as lamps, its small lights would be noise
    return material


def _light(
    tree: nodes.Tree, shot: Shot, place: Place, flaming: nodes.Value, embers: nodes.Value
) -> nodes.Value:
    """What flames and embers give off to the camera."""
    flame = tree.input("Flame Colour", FLAME, "Light of the burning edge", "Fire")
    ember = tree.input("Ember Colour", EMBER, "Light of the spots that glow in the ash", "Fire")
    bright = tree.input("Flame Brightness", _FLAME_LIGHT, "Radiance of the edge at exposure 0", "Fire")
    glowing = tree.input(
        "Ember Brightness",
        _EMBER_LIGHT if shot.settings.fire.embers else 0.0,
        "Radiance of the spots that glow in the ash, at exposure 0",
        "Fire",
    )
    light = tree.mix_colour(flaming / (flaming + embers + 1.0e-4), ember, flame)
    power = flaming * bright * place.distance.ramp(*CLOSE, _DIMMED, 1.0) + embers * glowing
    # Lamps and the smoke's glow carry the light of flames: rays that happen to meet the edge would be noise.
    seen = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    return tree.emission(light, power * seen)


def _place(tree: nodes.Tree, known: fields.Fields, shot: Shot) -> Place:
    radius = shot.settings.forest.draw_distance
    geometry = tree.node("ShaderNodeNewGeometry")
    position = tree.pick(geometry, "Position")
    slope = 1.0 - tree.separate(tree.pick(geometry, "True Normal"))[2]
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    wander = tree.noise(position, 170.0, 2.0) + tree.noise(position, 1100.0, 1.0) - 1.0
    age = nodes.model_time(tree) - known["burn_time"] + wander * (2.0 * _JITTER)
    edge = known["burned"] + (tree.noise(position, 120.0, 3.0) - 0.5) * 0.8
    burned = (age > 0.0) * (edge > 0.5)
    pixel = granite.pixel(tree, shot, distance)
    return Place(
        position,
        slope,
        known["canopy_fuel"],
        known["bare"],
        tree.attribute("elevation"),
        distance,
        known["stand"] * distance.ramp(max(radius, 1.0), _OWN * max(radius, 1.0), 1.0, 0.0),
        age,
        burned,
        pixel,
        granite.fine(tree, position, 0.6, 5.0, pixel, 0.72),
    )


def _rock(tree: nodes.Tree, place: Place) -> nodes.Value:
    """Bare rock 0..1: where nothing grows, on cliffs, and in outcrops that grow commoner with height."""
    ragged = tree.noise(place.position, 260.0, 6.0, 0.66)
    bare = (place.bare + (ragged - 0.5) * 1.7).smoothstep(0.42, 0.58) * (place.bare > 0.02)
    cliff = (place.slope + (ragged - 0.5) * 0.35).smoothstep(0.27, 0.36)
    high = (ragged + place.elevation.ramp(1300.0, 2700.0, -0.12, 0.12)).smoothstep(0.66, 0.74)
    return tree.math("MAXIMUM", bare, tree.math("MAXIMUM", cliff, high * 0.9))


def _unburned(
    tree: nodes.Tree, place: Place, rock: nodes.Value, stone: tuple[nodes.Value, nodes.Value]
) -> tuple[nodes.Value, nodes.Value]:
    """Colour, and height of the canopy (m) for the bump."""
    fine = tree.noise(place.position, 24.0, 4.0, 0.65)
    patch = tree.noise(place.position, 420.0, 4.0, 0.6)
    # From afar a crown is less than a pixel: its mean is shown, for what is left would be grain.
    sharp = place.distance.ramp(*_CROWNS_SEEN, 1.0, 0.2)
    crown = tree.mix(sharp, 0.52, tree.cells(place.position, 13.0).smoothstep(0.34, 0.70))
    tint, lone, _ = tree.separate(tree.cells(place.position, 13.0, "Color"))
    tint = tree.mix(sharp, 0.5, tint)
    groups = tree.noise(place.position, 120.0, 3.0, 0.7)
    cover = place.canopy + (patch - 0.5) * 0.9 + (groups - 0.5) * 1.6 + (fine - 0.5) * 0.6
    cover = cover.smoothstep(0.0, 0.7)
    alone = tree.mix(sharp, 0.25, (lone + (groups - 0.5) * 0.8) > 0.72)  # trees amid brush and on rock
    cover = tree.math("MAXIMUM", cover, alone * 0.85)
    floor = (place.canopy + (patch - 0.5) * 0.5 + (fine - 0.5) * 0.4).smoothstep(0.0, 0.35)
    deep = tree.input("Forest Dark", (0.026, 0.043, 0.016), "Darkest crowns of the far forest", "Forest")
    pale = tree.input("Forest Light", (0.072, 0.092, 0.036), "Lightest crowns of the far forest", "Forest")
    dark = tree.mix_colour(tint, deep, pale)
    stands = tree.noise(place.position, 1500.0, 5.0, 0.6)
    dark = tree.mix_colour(
        stands.smoothstep(0.40, 0.62), dark, tree.mix_colour(0.6, dark, (0.034, 0.072, 0.026))
    )
    clumps = tree.noise(place.position, 70.0, 3.0, 0.65).smoothstep(0.36, 0.64)
    dark = tree.mix_colour(clumps, tree.mix_colour(0.75, dark, (0.009, 0.014, 0.008)), dark)
    canopy = tree.mix_colour(crown, dark, (0.010, 0.015, 0.008))
    dry = place.elevation.ramp(500.0, 1500.0, 1.0, 0.0)
    meadow = tree.mix_colour(dry, (0.070, 0.070, 0.040), (0.110, 0.092, 0.052))
    soil = tree.mix_colour(fine, (0.115, 0.080, 0.050), (0.190, 0.140, 0.095))
    brush = tree.noise(place.position, 34.0, 5.0, 0.7) + (patch - 0.5) * 0.7 + dry * -0.12
    shrub = tree.mix_colour(tint, (0.030, 0.038, 0.017), (0.052, 0.058, 0.028))
    open_ground = tree.mix_colour(fine.smoothstep(0.38, 0.62), meadow, tree.mix_colour(0.55, meadow, soil))
    open_ground = tree.mix_colour(brush.smoothstep(0.36, 0.52) * 0.92, open_ground, shrub)
    far = tree.mix_colour(cover, open_ground, canopy)
    litter = tree.mix_colour(fine.smoothstep(0.3, 0.7), (0.019, 0.017, 0.010), (0.062, 0.050, 0.030))
    needles = tree.mix_colour(fine, (0.036, 0.025, 0.015), (0.078, 0.054, 0.033))
    beside = place.pixel.ramp(0.02, 0.20, 1.0, 0.0)  # brush is a colour but where it stands one by one
    litter = tree.mix_colour(beside, litter, needles)
    green = tree.noise(place.position, 5.0, 4.0, 0.65).smoothstep(0.47, 0.60) * (1.0 - beside * 0.85)
    scrub = tree.mix_colour(green, litter, (0.024, 0.033, 0.014))
    close = tree.mix_colour(floor, open_ground, scrub)
    colour = tree.mix_colour(place.near, far, close)
    colour = tree.mix_colour(1.0, colour, _grain(tree, place), "MULTIPLY")
    relief = cover * (1.0 - place.near) * (1.0 - crown) * 9.0 + fine * 2.0 + place.duff * 0.12
    boulders = tree.noise(place.position, 9.0, 4.0, 0.6) * 3.0 + stone[1]
    faces = tree.mix_colour(alone * (1.0 - place.near) * 0.8, stone[0], canopy)
    return tree.mix_colour(rock, colour, faces), tree.mix(rock, relief, boulders)


def _photographed(
    tree: nodes.Tree,
    place: Place,
    picture: photo.Picture,
    image: bpy.types.Image,
    colour: nodes.Value,
    bump: nodes.Value,
) -> tuple[nodes.Value, nodes.Value]:
    """Colour and bump with the photo's colour where it has any: what it shows of heights is in its light."""
    scale = 1.0 / (picture.high - picture.low)
    across = tree.vector("SUBTRACT", place.position, (*picture.low, 0.0))
    at = tree.vector("MULTIPLY", across, (*scale, 0.0))
    shown = tree.node("ShaderNodeTexImage", {"Vector": at}, image=image, extension="CLIP")
    counts = tree.pick(shown, "Alpha")
    return tree.mix_colour(counts, colour, tree.pick(shown, "Color")), bump * (1.0 - counts)


def _grain(tree: nodes.Tree, place: Place) -> nodes.Value:
    """Factor on the colour of the floor: needles, soil and shadows between them, 1 on average."""
    return tree.mix_colour(place.duff.ramp(-0.5, 0.5), (0.22, 0.20, 0.18), (1.78, 1.80, 1.82))


def _granite(tree: nodes.Tree, place: Place) -> tuple[nodes.Value, nodes.Value]:
    """Colour and height (m): slabs with joints, blocks of talus below them, sand and brush in the hollows."""
    stone, height = granite.face(tree, place.position, place.pixel)
    broad = tree.noise(place.position, 64.0, 6.0, 0.68)
    stone = tree.mix_colour(
        1.0,
        stone,
        tree.mix_colour(broad.smoothstep(0.3, 0.7), (0.60, 0.60, 0.62), (1.12, 1.08, 1.0)),
        "MULTIPLY",
    )
    stain = tree.noise(tree.vector("MULTIPLY", place.position, (1.0, 1.0, 0.25)), 90.0, 3.0)
    stone = tree.mix_colour(stain.smoothstep(0.5, 0.75) * 0.6, stone, (0.060, 0.050, 0.040))
    joints = granite.joints(tree, place.position, broad - 0.5, place.pixel)
    stone = tree.mix_colour(joints * 0.75, stone, (0.024, 0.022, 0.018))
    block = tree.cells(place.position, 2.4, "Color")
    bright = place.pixel.ramp(0.6, 2.4, tree.separate(block)[0], 0.5)
    debris = tree.mix_colour(bright, (0.055, 0.053, 0.050), (0.205, 0.195, 0.180))
    afar = place.pixel.ramp(0.05, 0.40)  # near by blocks and brush stand there one by one
    talus = place.slope.smoothstep(0.03, 0.10) * broad.smoothstep(0.49, 0.56) * afar
    stone = tree.mix_colour(talus, stone, debris)
    hollow = tree.noise(place.position, 26.0, 5.0, 0.68)
    sand = tree.mix_colour(broad, (0.105, 0.086, 0.060), (0.165, 0.140, 0.104))
    stone = tree.mix_colour((hollow - broad * 0.25).smoothstep(0.40, 0.47) * 0.85, stone, sand)
    brush = (hollow + joints * 0.07).smoothstep(0.555, 0.60) * (0.2 + afar * 0.8)
    return tree.mix_colour(brush * 0.88, stone, (0.030, 0.038, 0.018)), height * (1.0 - brush)


def _water(tree: nodes.Tree, place: Place) -> nodes.Value:
    """Dark water that mirrors the sky, more at grazing angles, ruffled by the wind."""
    ripples = tree.noise(place.position, 7.0, 2.0) * 0.05
    normal = tree.output("ShaderNodeBump", {"Strength": 0.5, "Distance": 1.0, "Height": ripples})
    colour = tree.input("Water Colour", (0.010, 0.022, 0.024), "Of deep lakes, seen from above", "Water")
    rough = tree.input("Water Roughness", 0.22, "How blurred a lake mirrors the sky", "Water", most=1.0)
    deep = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})
    mirror = tree.output("ShaderNodeBsdfGlossy", {"Roughness": rough, "Normal": normal})
    return tree.mix_shader(tree.output("ShaderNodeFresnel", {"IOR": 1.33}), deep, mirror)


def _charred(tree: nodes.Tree, place: Place, rock: nodes.Value, stone: nodes.Value) -> nodes.Value:
    """Char, white ash in streaks, brown scorched crowns where it burned mildly, and rock as it was."""
    tone = tree.noise(place.position, 90.0, 4.0, 0.62)
    dark = tree.input("Char Dark", (0.009, 0.008, 0.008), "Blackest char", "Scar")
    pale = tree.input("Char Light", (0.052, 0.046, 0.041), "Char mixed with soil", "Scar")
    white = tree.input("Ash Colour", (0.150, 0.142, 0.135), "White ash, some hours after the fire", "Scar")
    much = tree.input("Ash Amount", 0.6, "How white streaks of old ash become", "Scar", most=1.0)
    kept = tree.input("Scorch Amount", 0.75, "How brown it is where it burned mildly", "Scar", most=1.0)
    char = tree.mix_colour(tone.smoothstep(0.3, 0.72), dark, pale)
    ash = tree.noise(place.position, 33.0, 4.0, 0.6).smoothstep(0.58, 0.70)
    old = place.age.smoothstep(900.0, 14_400.0)
    char = tree.mix_colour(ash * old * much, char, white)
    mild = tree.noise(place.position, 540.0, 4.0, 0.6).smoothstep(0.54, 0.64) * place.canopy.smoothstep(
        0.1, 0.6
    )
    scorched = tree.mix_colour(tone, (0.035, 0.022, 0.012), (0.085, 0.052, 0.026))
    char = tree.mix_colour(mild * kept, char, scorched)
    char = tree.mix_colour(1.0, char, _grain(tree, place), "MULTIPLY")
    stone = tree.mix_colour(0.45, stone, (0.045, 0.042, 0.040))
    return tree.mix_colour(rock, char, stone)


def _glow(tree: nodes.Tree, place: Place, rock: nodes.Value) -> tuple[nodes.Value, nodes.Value]:
    """Flames of the edge and embers behind it, each 0..1."""
    fuel = place.burned * (1.0 - rock)
    tongues = tree.noise(place.position, 40.0, 4.0, 0.68).smoothstep(0.46, 0.60)
    duration = place.distance.ramp(1500.0, FAR, *FLAMING_TIME)
    body = place.age.smoothstep(0.0, 20.0) * (place.age / duration).smoothstep(1.0, 0.3)
    flaming = fuel * body * tongues
    speckles = tree.noise(place.position, 28.0, 4.0, 0.7).smoothstep(0.60, 0.72)
    clusters = tree.noise(place.position, 420.0, 2.0).smoothstep(0.42, 0.66)
    fading = (-(tree.math("MAXIMUM", place.age, 0.0) / EMBER_TIME)).exp()
    sparks = tree.math("MAXIMUM", place.duff * 4.0 + 1.0, 0.0)
    return flaming, fuel * speckles * clusters * fading * sparks
