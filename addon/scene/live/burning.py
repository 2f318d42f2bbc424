"""Shaders of burning in the live scene, from the time since the fire arrived: scar, front, embers, light."""

from __future__ import annotations

from ...blender import nodes
from ...shot.fire import heat_release
from ...shot.shot import Shot
from ..glow import EMBER, FAR, FLAME, FLAMING_TIME, brightness
from ..terrain import burn_scar

RAGGED = 60.0  # s, variation of the arrival time by noise
_REACH = 45.0  # m, decay length of the light of flames on the ground (by eye)
_FRONT = 0.3  # factor on the radiance of the flaming front (by eye)
_LIT = 0.35  # irradiance below flames over their radiance (by eye)


def short(shot: Shot) -> float:
    """Return the ratio of the burning time of the shot's surface fuel to the burning time of timber."""
    return min(shot.fire.smoke.residence / heat_release.FLAMING, 1.0)


def scar_colour(tree: nodes.Tree, fine: nodes.Value, coarse: nodes.Value, age: nodes.Value) -> nodes.Value:
    """Return the colour of burned ground from two noises: char, with ash after some hours."""
    char = tree.mix_colour(fine.smoothstep(0.35, 0.70), *burn_scar.CHAR)
    pale = coarse.smoothstep(0.48, 0.72) * age.smoothstep(*burn_scar.ASH_AGES).ramp(0.0, 1.0, 0.25, 0.8)
    return tree.mix_colour(pale, char, burn_scar.ASH)


def front_light(
    tree: nodes.Tree,
    shot: Shot,
    fine: nodes.Value,
    age: nodes.Value,
    speed: nodes.Value,
    distance: nodes.Value,
) -> nodes.Value:
    """Return the radiance of the flaming front and of embers behind it; far away the front is wider."""
    part = short(shot)
    lasts = distance.ramp(1500.0, FAR, *(part * time for time in FLAMING_TIME))
    wide = tree.math("MAXIMUM", lasts, distance * 1.0e-3 / tree.math("MAXIMUM", speed, 0.02))
    body = age.smoothstep(0.0, 15.0) * (age / wide).smoothstep(1.0, 0.3) * (lasts / wide)
    power = body * fine.smoothstep(0.44, 0.60) * (_FRONT * brightness(shot))
    flame = tree.vector("SCALE", tree.combine(*FLAME), power)
    if not shot.settings.fire.embers:
        return flame
    fading = (tree.math("MAXIMUM", age, 0.0) / -burn_scar.EMBER_TIME).exp() * (age > 0.0)
    spots = fine.smoothstep(0.62, 0.74) * fading * burn_scar.EMBER_LIGHT
    return tree.vector("ADD", flame, tree.vector("SCALE", tree.combine(*EMBER), spots))


def light_of_flames(tree: nodes.Tree, shot: Shot, age: nodes.Value, speed: nodes.Value) -> nodes.Value:
    """Return the light of flames on the ground around the front, relative to reflected white light."""
    beyond = tree.math("ABSOLUTE", age - 50.0 * short(shot)) * tree.math("MAXIMUM", speed, 0.02)
    near = (beyond / -_REACH).exp()
    return tree.vector("SCALE", tree.combine(*FLAME), near * (_LIT * brightness(shot)))
