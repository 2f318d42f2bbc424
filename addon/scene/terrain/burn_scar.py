"""Burn scar: char and ash of burned ground, and its flames and embers."""

from __future__ import annotations

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.shot import Shot
from .. import flame_field
from ..glow import CLOSE, EMBER, FAR, FLAME, FLAMING_TIME
from .shading_inputs import Place

EMBER_TIME = 3600.0  # s, decay time of embers of timber, to 1/e
_BENT = 1.75
"""Exponent of the decay time of embers in the residence time: 3600 (r / 120)^1.75 s, so 95 s in grass and
650 s in shrubs (assumed).
"""
_TIMBER = 120.0  # s, residence time in timber
_WIDE = 0.8  # minimum width of the flaming front, pixels; its coverage is reduced in proportion
_PALE = 0.55  # factor on the emission of grass flames, which are low and thin
_FLAME_LIGHT, _EMBER_LIGHT = 10.0, 1.8  # radiance at exposure 0
_DIMMED = 0.3  # factor on the emission of the flaming front close by
_BENEATH = 0.12  # factor on it below flames that are drawn as a field (by eye)
_COALS = 0.04, 0.5  # m, pixel sizes between which coals of a few cm blend into patches
_COAL_LIGHT = 0.12, 0.05  # factors on the emission of coals and of patches below the field of flames (by eye)
_COAL = (1.0, 0.055, 0.004)  # colour of embers there
_SPARSE = 0.25  # coverage of coals between patches, relative to within them (by eye)


def scar_colour(tree: nodes.Tree, place: Place) -> nodes.Value:
    """Return the colour of the scar: char, white ash in streaks, brown scorched crowns if severity is low."""
    tone = place.grain.noise(90.0 * place.scale, 4.0, 0.62)
    dark = tree.input("Char Dark", (0.009, 0.008, 0.008), "Blackest char", "Scar")
    pale = tree.input("Char Light", (0.052, 0.046, 0.041), "Char mixed with soil", "Scar")
    white = tree.input("Ash Colour", (0.150, 0.142, 0.135), "White ash, some hours after the fire", "Scar")
    much = tree.input("Ash Amount", 0.6, "How white streaks of old ash become", "Scar", most=1.0)
    kept = tree.input("Scorch Amount", 0.75, "How brown the scar is at low fire severity", "Scar", most=1.0)
    char = tree.mix_colour(tone.smoothstep(0.3, 0.72), dark, pale)
    ash = place.grain.noise(33.0 * place.scale, 4.0, 0.6).smoothstep(0.58, 0.70)
    old = (place.age * (_TIMBER / place.residence)).smoothstep(900.0, 14_400.0)
    char = tree.mix_colour(ash * old * much * (place.ash / 0.6), char, white)
    if place.mixed:
        char = tree.mix_colour(place.woody, _burned_grass_colour(tree, place, tone, ash * old), char)
    mild = place.grain.noise(540.0, 4.0, 0.6).smoothstep(0.54, 0.64) * place.canopy.smoothstep(0.1, 0.6)
    scorched = tree.mix_colour(tone, (0.035, 0.022, 0.012), (0.085, 0.052, 0.026))
    return tree.mix_colour(mild * kept, char, scorched)


def _burned_grass_colour(tree: nodes.Tree, place: Place, tone: nodes.Value, ash: nodes.Value) -> nodes.Value:
    """Return the colour of burned grass: black, then brown as its thin ash blows off, with unburned tufts."""
    broad = place.grain.noise(420.0 * place.scale, 3.0, 0.6)
    worn = place.age.smoothstep(120.0, 3600.0)
    pale = (tone * 0.7 + broad * 0.6 + worn * 0.08).smoothstep(0.52, 0.86)
    dark = tree.mix_colour(worn, (0.012, 0.010, 0.008), (0.024, 0.019, 0.014))
    char = tree.mix_colour(pale, dark, (0.075, 0.059, 0.042))
    char = tree.mix_colour(ash * 0.3, char, (0.120, 0.112, 0.103))
    tufts = place.grain.noise(12.0, 4.0, 0.7).smoothstep(0.60, 0.68) * broad.smoothstep(0.40, 0.60)
    return tree.mix_colour(tufts * 0.6, char, (0.135, 0.108, 0.068))


def front_coverage(tree: nodes.Tree, stage: Stage, place: Place) -> tuple[nodes.Value, nodes.Value]:
    """Return the coverage 0..1 of the flaming front, and of embers behind it, on ground with burned fuel.

    Within the field of flames the ground has only the light below them, and its embers are single coals.
    """
    part, size = place.residence / _TIMBER, place.scale
    clusters = place.grain.noise(420.0 * size, 2.0).smoothstep(0.42, 0.66)
    weak = place.speed.ramp(0.03, 0.4, 0.09, 0.0) + (1.0 - clusters) * 0.08  # gaps of low flames
    weak = weak * (1.0 - place.woody)
    tongues = (place.grain.noise(40.0 * size, 4.0, 0.68) - weak).smoothstep(0.46, 0.60)
    lasts = place.distance.ramp(1500.0, FAR, *FLAMING_TIME) * part
    shown = tree.math("MAXIMUM", lasts, _WIDE * place.pixel / tree.math("MAXIMUM", place.speed, 0.01))
    shown = tree.mix(place.woody, shown, lasts)
    body = (
        (place.age / part).smoothstep(0.0, 20.0) * (place.age / shown).smoothstep(1.0, 0.3) * (lasts / shown)
    )
    speckles = place.grain.noise(28.0 * size, 4.0, 0.7).smoothstep(0.60, 0.72)
    fading = (-(tree.math("MAXIMUM", place.age, 0.0) / (part.power(_BENT) * EMBER_TIME))).exp()
    patches = speckles * clusters * tree.math("MAXIMUM", place.duff * 4.0 + 1.0, 0.0)
    coals = place.duff.smoothstep(0.10, 0.26) * tree.math("MAXIMUM", speckles, _SPARSE)
    embers = tree.mix(place.pixel.ramp(*_COALS), coals, patches) * place.woody.ramp(0.0, 1.0, 0.3, 1.0)
    beyond = flame_field.share(tree, stage).ramp(0.0, 1.0, _BENEATH, 1.0)
    return body * tongues * beyond, embers * fading


def fire_emission(tree: nodes.Tree, shot: Shot, stage: Stage, place: Place, fuel: nodes.Value) -> nodes.Value:
    """Return the emission of flames and embers to the camera, scaled by the burned `fuel` (0..1)."""
    flaming, embers = front_coverage(tree, stage, place)
    flame = tree.input("Flame Colour", FLAME, "Light of the burning edge", "Fire")
    ember = tree.input("Ember Colour", EMBER, "Light of the spots that glow in the ash", "Fire")
    bright = tree.input("Flame Brightness", _FLAME_LIGHT, "Radiance of the edge at exposure 0", "Fire")
    glowing = tree.input(
        "Ember Brightness",
        _EMBER_LIGHT if shot.settings.fire.embers else 0.0,
        "Radiance of the spots that glow in the ash, at exposure 0",
        "Fire",
    )
    beyond = flame_field.share(tree, stage)
    ember = tree.mix_colour(beyond, _COAL, ember)
    glowing = glowing * tree.mix(beyond, place.pixel.ramp(*_COALS, *_COAL_LIGHT), 1.0)
    colour = tree.mix_colour(flaming / (flaming + embers + 1.0e-4), ember, flame)
    bright = bright * place.woody.ramp(0.0, 1.0, _PALE, 1.0)
    power = flaming * bright * place.distance.ramp(*CLOSE, _DIMMED, 1.0) + embers * glowing
    shining = {0: fuel, 2: tree.emission(colour, power)}  # nodes are not evaluated without fuel
    return tree.output("ShaderNodeMixShader", shining)
