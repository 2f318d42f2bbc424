"""Material of smoke that was solved: its files hold the extinction itself; here it gets colour and light.

Smoke scatters light mostly forwards, so light goes on through it much as if it were thinner and scattered
more evenly (Joseph, Wiscombe and Weinman 1976, "The delta-Eddington approximation for radiative flux
transfer"). So one bounce does for many: of a ball 16 deep in the sun it is off 24 bounces by 11 to 16 % of
the light, and one bounce of nearly even scattering by 13 to 54 %. Camera's rays, which draw outlines, meet
all of the smoke.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.light import exposure
from ...shot.shot import Shot
from ...smoke import flow_frames
from .. import haze, infrared
from . import material, sunlit

_PALE, _FRESH = (
    (0.80, 0.77, 0.73),
    (0.44, 0.36, 0.29),
)  # albedo: of a grass fire; of a crown fire's soot and char
_OLD = np.array([1.005, 1.0, 0.995])  # of aged haze and cloud, over its albedo in green light
_MIDDLE = (0.86, 0.83, 0.79)  # what light that reaches smoke by way of other smoke meets
FORWARD = 0.6  # anisotropy of smoke (Reid et al. 2005: 0.5 to 0.65 in green light)
_ANISOTROPY = FORWARD / (1.0 + FORWARD)  # of what is left when light that goes on counts as not scattered
_HIDDEN = (
    30.0  # times that hidden smoke counts besides, so that camera's rays, which go on to 1e-6, end there
)
_LIGHT = 0.5  # of extinction counts for light: 0.7 by theory, less for the bounces that are left out


@dataclass(frozen=True)
class _Smoke:
    """Extinction (1/m) for camera's rays and for those of light, albedo and anisotropy."""

    density: nodes.Value
    thinner: nodes.Value
    albedo: nodes.Value
    even: nodes.Value


def build(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Smoke"."""
    made, tree = nodes.material("Firetwin Smoke")
    young = material.between(_PALE, _FRESH, shot.fire.smoke.dark)
    fresh = tree.input("Fresh Colour", young, "Albedo of fresh smoke: dark with soot, or pale", "Colour")
    old = tree.input(
        "Old Colour", tuple(_OLD * shot.fire.smoke.white), "Albedo of aged haze and cloud", "Colour"
    )
    thick = tree.input("Density", 1.0, "Factor on how thick smoke is", "Density")
    even = tree.input("Anisotropy", _ANISOTROPY, "How much light goes on forwards", "Light", -0.99, 0.99)
    density = tree.attribute("density") * thick
    albedo = tree.mix_colour(tree.attribute("fresh"), old, fresh)
    thinner = density * tree.input("Light Density", _LIGHT, "Part of the smoke that dims light", "Light")
    seen = density * (1.0 + tree.attribute("hidden") * _hiding(tree, thick))
    lit = _solved if shot.settings.smoke.lighting == "solved" else _traced
    visible = lit(tree, shot, stage, _Smoke(seen, thinner, albedo, even))
    shader = infrared.smoke(tree, shot, stage, visible, density)
    # A mix by 0 or 1 evaluates one side only, and more than half of all steps find no smoke.
    clear = tree.output("ShaderNodeVolumeAbsorption", {"Density": 0.0})
    tree.volume(tree.mix_shader(density > 0.5 * flow_frames.thinnest(shot.scale), clear, shader))
    made.cycles.volume_sampling = "DISTANCE"
    made.cycles.emission_sampling = "NONE"
    return made


def _solved(tree: nodes.Tree, shot: Shot, stage: Stage, smoke: _Smoke) -> nodes.Value:
    """Smoke that shines by itself, as much as the light in its grids makes it."""
    part, air = haze.fraction(tree, stage)
    light = sunlit.source(tree, shot, smoke.albedo, smoke.even)
    if glow := _glow(tree, shot, smoke.density):
        light = tree.vector("ADD", light, tree.vector("SCALE", *glow))
    seen = tree.add_shader(
        _black(tree, smoke.density), tree.emission(tree.mix_colour(part, light, air), smoke.density)
    )
    # What lakes mirror is seen too. Of what shines, other rays gather 0.02/255 of a picture of the example.
    path = tree.node("ShaderNodeLightPath")
    looks = tree.math("MAXIMUM", *(tree.pick(path, name) for name in ("Is Camera Ray", "Is Glossy Ray")))
    return tree.mix_shader(looks, _black(tree, smoke.thinner), seen)


def _traced(tree: nodes.Tree, shot: Shot, stage: Stage, smoke: _Smoke) -> nodes.Value:
    """Smoke whose light Cycles traces."""
    middle = tree.input("Inner Colour", _MIDDLE, "Albedo for light by way of other smoke", "Colour")
    part, air = haze.fraction(tree, stage)
    light = tree.emission(air, part * smoke.density)
    if glow := _glow(tree, shot, smoke.density):
        shine, bright = glow
        light = tree.add_shader(light, tree.emission(shine, bright * (1.0 - part) * smoke.density))
    scattered = tree.mix_colour(part, smoke.albedo, (0.0, 0.0, 0.0))
    detailed = tree.add_shader(material.smoke(tree, smoke.density, scattered, smoke.even), light)
    # Most steps belong to rays of light through the smoke; one grid is enough for them.
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    return tree.mix_shader(camera, material.smoke(tree, smoke.thinner, middle, smoke.even), detailed)


def _hiding(tree: nodes.Tree, thick: nodes.Value) -> nodes.Value:
    """Times that hidden smoke counts besides; 0 where smoke is drawn thinner than it is, and hides less."""
    factor = tree.input(
        "Hidden Density", _HIDDEN, "Times that smoke no camera sees counts besides", "Density"
    )
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    return factor * camera * (thick > 0.99)


def _black(tree: nodes.Tree, density: nodes.Value) -> nodes.Value:
    return tree.output("ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.0, 0.0), "Density": density})


def _glow(tree: nodes.Tree, shot: Shot, density: nodes.Value) -> tuple[nodes.Value, nodes.Value] | None:
    """Colour and brightness of the flames' light in smoke, where it is dark enough to see it."""
    if exposure.darkness(shot, shot.frames.middle) <= 0.0:
        return None
    shine, bright = material.glow_inputs(tree, shot)
    return shine, tree.attribute("glow") * bright * material.glowing(density)
