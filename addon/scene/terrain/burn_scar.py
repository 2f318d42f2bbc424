"""Burn scar: char and ash of burned ground, and its flames and embers."""

from __future__ import annotations

import numpy as np

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.light import exposure
from ...shot.shot import Shot
from .. import flame_field
from ..glow import CLOSE, EMBER, FAR, FLAME, FLAMING_TIME, dimming
from . import burning_wood
from .shading_inputs import GroundInputs

EMBER_TIME = 3600.0  # s, decay time of embers of timber, to 1/e
_BENT = 1.75
"""Exponent of the decay time of embers in the residence time: 3600 (r / 120)^1.75 s, so 95 s in grass and
650 s in shrubs (assumed).
"""
_TIMBER = 120.0  # s, residence time in timber
CHAR = (0.012, 0.012, 0.0125), (0.048, 0.046, 0.043)
"""Blackest char, and char mixed with soil."""
ASH = (0.125, 0.123, 0.120)
ASH_AGES = 600.0, 14_400.0
"""s since the fire in timber, in which wind and dew bare the pale ash (assumed)."""
EMBER_LIGHT = 1.8
"""Radiance of embers at exposure 0."""
_SEVERE = 500.0, 8000.0  # kW/m, intensities of a surface fire and of a crown fire, which consumes all litter
_SCORCHED = 90.0, 220.0, 450.0, 1000.0
"""kW/m, intensities between which far crowns turn brown, and between which they burn. By Van Wagner (1973),
crowns of trees of 18 m are scorched to a third at 240 kW/m; by Van Wagner (1977), they torch from 400 kW/m.
"""
_GREEN = 260.0, 80.0  # kW/m, intensities from which no crown and below which all crowns stay green
_LOGS = 0.55  # fraction of the cells with a log that burned out (by eye)
_WISP = (1.0, 0.30, 1.0)  # streaks of ash are three times as long as wide (by eye)
_WISP_ASH = (0.21, 0.205, 0.198)
_STUBS = (0.135, 0.110, 0.066)  # straw below the flames
_WIDE = 0.8  # minimum width of the flaming front, pixels; its coverage is reduced in proportion
_PALE = 0.55  # factor on the emission of grass flames, which are low and thin
_FLAME_LIGHT = 10.0  # radiance at exposure 0
_DIMMED = 0.3  # factor on the emission of the flaming front close by
_BENEATH = 0.06  # factor on it below flames that are drawn as a field (by eye)
_COALS = 0.04, 0.5  # m, pixel sizes between which coals of a few cm blend into patches
_COAL_LIGHT = 0.12, 0.05  # factors on the emission of coals and of patches below the field of flames (by eye)
_COAL = (1.0, 0.17, 0.012)  # colour of embers there: with less green, AgX shows bright ones as pink
_FRESH = 240.0, 2.0, 0.35
"""s, decay time of the light of fresh coals of timber, to 1/e, before ash covers them (assumed); factors on
the light of coals when fresh and later (by eye)."""
_LONG = 1.0  # stops, exposure from which coals and the ground beneath flames near the camera shine less
_WOOD_LIGHT = 2.5  # radiance of burning stumps and logs at exposure 0 (by eye)
_GLOWING = 0.05
"""Area fraction of glowing coals in a patch of embers (assumed): at 850 K they radiate 1.5 kW/m2."""
_SPARSE = 0.25  # coverage of coals between patches, relative to within them (by eye)


def scar_colour(tree: nodes.Tree, place: GroundInputs, *, logs: bool = False) -> nodes.Value:
    """Return the colour of the scar by intensity, fuel and age: char, grey ash, white ash, scorched crowns.

    Char has a reflectance of 0.01 to 0.05. Ash is pale where much fuel burned, and more so after some hours.
    With `logs`, white ash has the shape of burned-out logs close by.
    """
    tone = place.grain.noise(90.0 * place.scale, 4.0, 0.62)
    dark = tree.input("Char Dark", CHAR[0], "Blackest char", "Scar")
    pale = tree.input("Char Light", CHAR[1], "Char mixed with soil", "Scar")
    grey = tree.input("Ash Colour", ASH, "Grey ash, some hours after the fire", "Scar")
    white = tree.input("White Ash", (0.320, 0.317, 0.312), "Ash of wood that burned out", "Scar")
    much = tree.input("Ash Amount", 0.6, "How much of the scar ash covers", "Scar", most=1.0)
    kept = tree.input("Scorch Amount", 0.75, "How brown the scar is at low fire severity", "Scar", most=1.0)
    char = tree.mix_colour(tone.smoothstep(0.38, 0.70), dark, pale)
    heavy = place.load.smoothstep(0.3, 3.0)
    hours = (place.age * (_TIMBER / place.residence)).smoothstep(*ASH_AGES)
    flakes = place.grain.noise(33.0 * place.scale, 4.0, 0.6)
    film = flakes + heavy * 0.04 + place.heat.smoothstep(*np.log(_SEVERE)) * 0.06
    film = film.smoothstep(0.57, 0.80) * hours.ramp(0.0, 1.0, 0.3, 1.0) * much * (place.ash / 0.6)
    char = tree.mix_colour(film, char, grey)
    burned_out = (place.grain.noise(13.0, 4.0, 0.66) + (flakes - 0.5) * 0.5).smoothstep(0.66, 0.74)
    if logs:
        burned_out = tree.math("MAXIMUM", burned_out, _log_ash(tree, place))
    burned_out = burned_out * heavy * hours.ramp(0.0, 1.0, 0.35, 1.0) * much * place.woody
    char = tree.mix_colour(burned_out, char, white)
    if place.mixed:
        char = tree.mix_colour(place.woody, _burned_grass_colour(tree, place, tone, film), char)
    low, full, gone, none = np.log(_SCORCHED)
    varied = _uneven_heat(place)
    brown = varied.smoothstep(low, full) * varied.smoothstep(none, gone) * place.canopy.smoothstep(0.1, 0.6)
    scorched = tree.mix_colour(tone, (0.041, 0.030, 0.019), (0.077, 0.055, 0.034))
    return tree.mix_colour(brown * kept, char, scorched)


def surviving_crowns(place: GroundInputs) -> nodes.Value:
    """Return the fraction 0..1 of crowns that stay green over a surface fire."""
    return _uneven_heat(place).smoothstep(*np.log(_GREEN)) * place.canopy.smoothstep(0.1, 0.6)


def _uneven_heat(place: GroundInputs) -> nodes.Value:
    """Return ln(kW/m) with patches of stands and groups of trees: winds, slopes and fuel vary (by eye)."""
    patches = (place.grain.noise(540.0, 4.0, 0.6) - 0.5) * 2.4
    return place.heat + patches + (place.grain.noise(70.0, 2.0, 0.6) - 0.5) * 1.2


def _log_ash(tree: nodes.Tree, place: GroundInputs) -> nodes.Value:
    """Return white streaks 0..1 of logs that burned out, in cells of 11 m, seen close by only."""
    x, y, _ = tree.separate(place.position)
    cells = tree.node("ShaderNodeTexVoronoi", {"Vector": tree.combine(x, y, 0.0), "Scale": 1.0 / 11.0})
    turn, size, chance = tree.separate(tree.pick(cells, "Color"))
    left, below, _ = tree.separate(tree.pick(cells, "Position"))
    east, north, turn = x - left, y - below, turn * (2.0 * np.pi)
    sine, cosine = tree.math("SINE", turn), tree.math("COSINE", turn)
    along = tree.math("ABSOLUTE", east * cosine + north * sine)
    bend = (place.grain.noise(2.5, 3.0, 0.7) - 0.5) * 1.6
    across = tree.math("ABSOLUTE", north * cosine - east * sine + bend)
    length, width = size.ramp(0.0, 1.0, 2.0, 5.5), size.ramp(0.0, 1.0, 0.35, 0.8)
    shape = across.smoothstep(width, width * 0.4) * along.smoothstep(length, length * 0.7)
    return shape * (chance < _LOGS) * place.pixel.ramp(0.3, 2.0, 1.0, 0.0)


def _burned_grass_colour(
    tree: nodes.Tree, place: GroundInputs, tone: nodes.Value, ash: nodes.Value
) -> nodes.Value:
    """Return the colour of burned grass: thin black, soil where ash blew off, stubs and tufts of straw."""
    broad = place.grain.noise(420.0 * place.scale, 3.0, 0.6)
    worn = place.age.smoothstep(120.0, 7200.0)
    pale = (tone * 0.7 + broad * 0.6 + worn * 0.08).smoothstep(0.60, 0.96)
    dark = tree.mix_colour(worn, (0.019, 0.019, 0.018), (0.031, 0.030, 0.028))
    char = tree.mix_colour(pale, dark, (0.071, 0.066, 0.059))
    char = tree.mix_colour(ash * 0.4, char, (0.125, 0.124, 0.122))
    char = tree.mix_colour(place.duff.smoothstep(0.10, 0.42) * 0.35, char, _STUBS)
    char = _matted_ash(tree, place, char)
    tufts = place.grain.noise(12.0, 4.0, 0.7).smoothstep(0.60, 0.68) * broad.smoothstep(0.40, 0.60)
    return tree.mix_colour(tufts * 0.5, char, (0.120, 0.100, 0.066))


def _matted_ash(tree: nodes.Tree, place: GroundInputs, char: nodes.Value) -> nodes.Value:
    """Return the colour of burned grass with mats of black residue, and thin streaks of white ash between."""
    mats = place.grain.noise(2.2, 4.0, 0.72)
    tone = mats.ramp(0.3, 0.7, 0.45, 1.15)
    char = tree.mix_colour(1.0, char, tree.combine(tone, tone, tone), "MULTIPLY")
    wisps = place.grain.at(tree.vector("MULTIPLY", place.position, _WISP)).noise(9.0, 5.0, 0.72)
    line = tree.math("ABSOLUTE", wisps - 0.5).smoothstep(0.03, 0.0) * mats.smoothstep(0.46, 0.60)
    return tree.mix_colour(line * place.pixel.ramp(0.3, 2.0, 0.28, 0.08), char, _WISP_ASH)


def front_coverage(tree: nodes.Tree, stage: Stage, place: GroundInputs) -> tuple[nodes.Value, nodes.Value]:
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


def glowing_fraction(tree: nodes.Tree, place: GroundInputs) -> nodes.Value:
    """Return the fraction 0..1 of the area of embers that glows: single coals close by, patches from afar."""
    return place.pixel.ramp(*_COALS, 1.0, _GLOWING)


def fire_emission(
    tree: nodes.Tree, shot: Shot, stage: Stage, place: GroundInputs, fuel: nodes.Value
) -> tuple[nodes.Value, nodes.Value]:
    """Return shader and radiance of flames and embers to the camera, scaled by the burned `fuel` (0..1)."""
    flaming, embers = front_coverage(tree, stage, place)
    flame = tree.input("Flame Colour", FLAME, "Light of the burning edge", "Fire")
    ember = tree.input("Ember Colour", EMBER, "Light of the spots that glow in the ash", "Fire")
    bright = tree.input("Flame Brightness", _FLAME_LIGHT, "Radiance of the edge at exposure 0", "Fire")
    glowing = tree.input(
        "Ember Brightness",
        EMBER_LIGHT if shot.settings.fire.embers else 0.0,
        "Radiance of the spots that glow in the ash, at exposure 0",
        "Fire",
    )
    beyond = flame_field.share(tree, stage)
    ember = tree.mix_colour(beyond, _COAL, ember)
    fresh = (tree.math("MAXIMUM", place.age, 0.0) * (-_TIMBER / _FRESH[0]) / place.residence).exp()
    dim = dimming(max(exposure.middle(shot) - _LONG, 0.0))  # or long exposures would clip
    coals = place.pixel.ramp(*_COALS, *_COAL_LIGHT) * fresh.ramp(0.0, 1.0, _FRESH[2] * dim, _FRESH[1] * dim)
    embers = embers * glowing * tree.mix(beyond, coals, 1.0)
    wood = burning_wood.glow(tree, place) * tree.input(
        "Wood Brightness",
        _WOOD_LIGHT if shot.settings.fire.embers else 0.0,
        "Radiance of stumps and logs that burn on, at exposure 0",
        "Fire",
    )
    flames = flaming * bright * place.woody.ramp(0.0, 1.0, _PALE, 1.0)
    flames = flames * place.distance.ramp(*CLOSE, _DIMMED, 1.0) * tree.mix(beyond, dim, 1.0)
    power = flames + embers + wood
    some = power + 1.0e-4
    colour = tree.mix_colour(flames / some, tree.mix_colour(wood / some, ember, burning_wood.COLOUR), flame)
    shining = {0: fuel, 2: tree.emission(colour, power)}  # nodes are not evaluated without fuel
    shown = power * fuel
    glow = tree.vector("MULTIPLY", colour, tree.combine(shown, shown, shown))
    return tree.output("ShaderNodeMixShader", shining), glow
