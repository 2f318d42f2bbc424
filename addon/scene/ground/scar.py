"""What the fire has made of the ground: char and ash, and the flames and embers in it."""

from __future__ import annotations

from ...blender import nodes
from ...shot.shot import Shot
from ..glow import CLOSE, EMBER, FAR, FLAME, FLAMING_TIME
from .place import Place

EMBER_TIME = 3600.0  # s in which embers fade to 1/e
_FLAME_LIGHT, _EMBER_LIGHT = 10.0, 1.8  # radiance at exposure 0
_DIMMED = 0.3  # part of their light that flames of the edge have near by


def charred(tree: nodes.Tree, place: Place) -> nodes.Value:
    """Colour: char, white ash in streaks, brown scorched crowns where it burned mildly."""
    tone = place.grain.noise(90.0, 4.0, 0.62)
    dark = tree.input("Char Dark", (0.009, 0.008, 0.008), "Blackest char", "Scar")
    pale = tree.input("Char Light", (0.052, 0.046, 0.041), "Char mixed with soil", "Scar")
    white = tree.input("Ash Colour", (0.150, 0.142, 0.135), "White ash, some hours after the fire", "Scar")
    much = tree.input("Ash Amount", 0.6, "How white streaks of old ash become", "Scar", most=1.0)
    kept = tree.input("Scorch Amount", 0.75, "How brown it is where it burned mildly", "Scar", most=1.0)
    char = tree.mix_colour(tone.smoothstep(0.3, 0.72), dark, pale)
    ash = place.grain.noise(33.0, 4.0, 0.6).smoothstep(0.58, 0.70)
    old = place.age.smoothstep(900.0, 14_400.0)
    char = tree.mix_colour(ash * old * much, char, white)
    mild = place.grain.noise(540.0, 4.0, 0.6).smoothstep(0.54, 0.64) * place.canopy.smoothstep(0.1, 0.6)
    scorched = tree.mix_colour(tone, (0.035, 0.022, 0.012), (0.085, 0.052, 0.026))
    return tree.mix_colour(mild * kept, char, scorched)


def glow(tree: nodes.Tree, place: Place) -> tuple[nodes.Value, nodes.Value]:
    """Flames of the edge and embers behind it, each 0..1, where there is fuel that has burned."""
    tongues = place.grain.noise(40.0, 4.0, 0.68).smoothstep(0.46, 0.60)
    duration = place.distance.ramp(1500.0, FAR, *FLAMING_TIME)
    body = place.age.smoothstep(0.0, 20.0) * (place.age / duration).smoothstep(1.0, 0.3)
    speckles = place.grain.noise(28.0, 4.0, 0.7).smoothstep(0.60, 0.72)
    clusters = place.grain.noise(420.0, 2.0).smoothstep(0.42, 0.66)
    fading = (-(tree.math("MAXIMUM", place.age, 0.0) / EMBER_TIME)).exp()
    sparks = tree.math("MAXIMUM", place.duff * 4.0 + 1.0, 0.0)
    return body * tongues, speckles * clusters * fading * sparks


def light(tree: nodes.Tree, shot: Shot, place: Place, fuel: nodes.Value) -> nodes.Value:
    """What flames and embers give off to the camera, by how much burned `fuel` (0..1) there is."""
    flaming, embers = glow(tree, place)
    flame = tree.input("Flame Colour", FLAME, "Light of the burning edge", "Fire")
    ember = tree.input("Ember Colour", EMBER, "Light of the spots that glow in the ash", "Fire")
    bright = tree.input("Flame Brightness", _FLAME_LIGHT, "Radiance of the edge at exposure 0", "Fire")
    glowing = tree.input(
        "Ember Brightness",
        _EMBER_LIGHT if shot.settings.fire.embers else 0.0,
        "Radiance of the spots that glow in the ash, at exposure 0",
        "Fire",
    )
    colour = tree.mix_colour(flaming / (flaming + embers + 1.0e-4), ember, flame)
    power = flaming * bright * place.distance.ramp(*CLOSE, _DIMMED, 1.0) + embers * glowing
    shining = {0: fuel, 2: tree.emission(colour, power)}  # nothing is worked out where there is no fuel
    return tree.output("ShaderNodeMixShader", shining)
