"""Material of firebrands: glowing wood, dimmed where its streak is drawn larger than the firebrand."""

from __future__ import annotations

import bpy

from ...blender import nodes
from ...blender.owned import Stage
from ...passes import masks
from ...shot.shot import Shot
from .. import glow, haze, infrared

_COOL, _HOT = (1.0, 0.10, 0.008), (1.0, 0.42, 0.10)
_LIGHT = 10.0  # radiance relative to flames; chosen by eye, as in a long exposure
COLD, FRESH = 900.0, 1300.0  # K


def build(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Firebrand", whose instances carry `kelvin`, `shine` (0..1) and `cover`.

    `cover` is the firebrand's area as a fraction 0..1 of the drawn streak's area.
    """
    material, tree = nodes.material("Firetwin Firebrand")
    kelvin, shine, cover = (tree.attribute(name, "INSTANCER") for name in ("kelvin", "shine", "cover"))
    cool = tree.input("Cool Colour", _COOL, "Colour of a piece that is about to go out", "Colour")
    fresh = tree.input("Hot Colour", _HOT, "Colour of a piece just torn off", "Colour")
    bright = tree.input("Brightness", _LIGHT * glow.brightness(shot), "Radiance of a fresh piece", "Light")
    part, _air = haze.fraction(tree, stage)
    colour = tree.mix_colour(kelvin.ramp(COLD, FRESH), cool, fresh)
    strength = shine * cover * (1.0 - part) * bright
    clear = tree.output("ShaderNodeBsdfTransparent", {"Color": (1.0, 1.0, 1.0)})
    glowing = tree.add_shader(tree.emission(colour, strength), clear)
    warmth = infrared.radiance_at_camera(
        tree, shot, stage, infrared.surface_radiance(tree, shot, stage, kelvin)
    )
    nodes.flames(tree, tree.separate(colour)[0] * strength, cover, warmth)
    warm = tree.mix_shader(cover, clear, tree.emission(warmth, 1.0))
    shader = nodes.switch(tree, nodes.THERMAL, glowing, warm)
    tree.surface(nodes.mask_switch(tree, shader, masks.FIRE))
    material.cycles.emission_sampling = "NONE"
    return material
