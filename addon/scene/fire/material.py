"""Material of flames: billboards cut into tongues by noise; deep orange, with additive emission."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from ...blender import nodes
from ...blender.owned import Stage
from ...passes import masks
from ...shot.fire import flame_clock
from ...shot.shot import Shot
from .. import flame_field, glow, haze, infrared

_DIMMED = 0.2  # factor on the emission at the shorter distance of `glow.CLOSE`
_FULL = 0.5, (1.5, 10.0)  # factor on the emission of low flames, which are thin; lengths, m
RISE = 9.0  # m/s, rise velocity of the pattern
RAGGED = 2.6  # strength of the turbulence that tears a flame


def build(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Flame" for the billboards of `fire`; the attribute `card` spans -1..1 and 0..1."""
    material, tree = nodes.material("Firetwin Flame", (1.00, 0.25, 0.02))
    rim, middle, core = (
        tree.input(f"{name} Colour", colour, help, "Colour")
        for name, colour, help in (
            ("Rim", glow.RIM, "Outermost, coolest part of a flame"),
            ("Body", glow.BODY, "Most of a flame"),
            ("Core", glow.CORE, "Hottest part of a flame"),
        )
    )
    bright = tree.input("Brightness", glow.brightness(shot), "Radiance of the hottest part", "Light")
    speed = tree.input("Rise", RISE, "Speed (m/s) at which the pattern rises", "Motion")
    ragged = tree.input("Raggedness", RAGGED, "How much turbulence tears a flame", "Shape")
    across, up, _ = tree.separate(tree.attribute("card", output="Vector"))
    seed = tree.attribute("seed", "INSTANCER")
    length = tree.attribute("flame_length", "INSTANCER")
    first = shot.frames.first
    time = (nodes.model_time(tree) - first) * flame_clock.pace(shot.frames) + first
    rise = time * speed / tree.math("MAXIMUM", length, 4.0)
    slim = length / tree.math("MAXIMUM", tree.attribute("flame_width", "INSTANCER"), 0.5)
    slow = tree.combine(across * 0.8 + seed * 917.0, up * slim * 0.6 - rise * 0.7, seed * 211.0 + time * 0.11)
    fast = tree.combine(across * 1.6 + seed * 431.0, up * slim * 1.1 - rise, seed * 97.0 + time * 0.23)
    sway = tree.noise(slow, 1.0, 1.0) - 0.5
    tongue = tree.noise(fast, 1.0, 3.0, 0.6)
    centre = across + sway * up * 1.5
    narrow = (1.0 - up).power(0.65) * 0.95
    body = 1.0 - tree.math("ABSOLUTE", centre) / tree.math("MAXIMUM", narrow, 0.02)
    shape, hot, colour = tear(tree, body, tongue, up, ragged, (rim, middle, core))
    drawn = flame_field.share(tree, stage)
    strength = shape.power(1.3) * (0.35 + hot * 0.65) * bright * drawn
    strength = strength * tree.output("ShaderNodeCameraData", name="View Distance").ramp(
        *glow.CLOSE, _DIMMED, 1.0
    )
    strength = strength * length.ramp(*_FULL[1], _FULL[0], 1.0)
    part, _air = haze.fraction(tree, stage)
    behind = 1.0 - shape * drawn * 0.5
    clear = tree.output("ShaderNodeBsdfTransparent", {"Color": tree.combine(behind, behind, behind)})
    light = strength * (1.0 - part)
    shader = tree.add_shader(tree.emission(colour, light), clear)
    flame = shape > 0.12
    gap = tree.output("ShaderNodeBsdfTransparent")  # does not hide the heat behind it
    depth = tree.attribute("flame_width", "INSTANCER")
    emissivity = flame * drawn * (1.0 - (depth * -infrared.FLAME).exp())
    warmth = infrared.surface_radiance(tree, shot, stage, tree.attribute("kelvin", "INSTANCER"))
    warmth = infrared.radiance_at_camera(tree, shot, stage, warmth)
    hot = tree.mix_shader(emissivity, gap, tree.emission(warmth, 1.0))
    nodes.flames(tree, tree.separate(colour)[0] * light * flame, emissivity, warmth)
    shader = nodes.switch(tree, nodes.THERMAL, tree.mix_shader(flame, clear, shader), hot)
    whole = tree.mix_shader(flame * (drawn > 0.5), gap, tree.emission((0.0, 1.0, masks.FIRE), 1.0))
    tree.surface(nodes.switch(tree, nodes.MASKS, shader, whole))
    material.cycles.emission_sampling = "NONE"
    return material


def tear(
    tree: nodes.Tree,
    body: nodes.Value,
    tongue: nodes.Value,
    up: nodes.Value,
    ragged: nodes.Value | float,
    colours: Sequence[nodes.Value | tuple[float, float, float]],
) -> tuple[nodes.Value, nodes.Value, nodes.Value]:
    """Tear a flame by noise: return its coverage 0..1, its heat 0..1 and its colour.

    Parameters
    ----------
    body
        1 in the middle of the flame, 0 at its sides.
    tongue
        Noise 0..1.
    up
        Height in the flame, 0..1.
    ragged
        Strength of the noise.
    colours
        Of the rim, the body and the core.
    """
    rim, middle, core = colours
    torn = body + (tongue - 0.5) * ragged - up.power(1.5) * 0.75
    shape = torn.smoothstep(0.05, 0.75) * up.smoothstep(0.0, 0.06) * up.smoothstep(1.0, 0.85)
    hot = (torn - up * 0.4).smoothstep(0.5, 1.5)
    colour = tree.mix_colour(shape.smoothstep(0.15, 0.8), rim, middle)
    return shape, hot, tree.mix_colour(hot, colour, core)
