"""Material of solved smoke: the grids hold extinction; the material adds colour and light.

Smoke scatters light mostly forwards, so it attenuates about as much as thinner smoke with more isotropic
scattering (Joseph, Wiscombe and Weinman 1976, "The delta-Eddington approximation for radiative flux
transfer"). So one bounce replaces many: for a ball of optical depth 16 in the sun its error is 11 to 16 % of
the light against 24 bounces. One bounce of nearly isotropic scattering has 13 to 54 %. Camera rays, which
decide outlines, use the full extinction.
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
_OLD = np.array([1.005, 1.0, 0.995])  # albedo of aged haze and cloud, over its value in green light
_MIDDLE = (0.86, 0.83, 0.79)  # factor on light that reaches smoke through other smoke
FORWARD = 0.6  # anisotropy of smoke (Reid et al. 2005: 0.5 to 0.65 in green light)
# anisotropy that is left after forward-scattered light counts as not scattered
_ANISOTROPY = FORWARD / (1.0 + FORWARD)
_HIDDEN = 30.0  # factor of extinction in hidden smoke, where camera rays, which go on to 1e-6, can end
_LIGHT = 0.5  # fraction of extinction for light rays: 0.7 by theory, less for the bounces left out


@dataclass(frozen=True)
class _Smoke:
    """Extinction (1/m) for camera rays and for light rays, albedo and anisotropy."""

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
    extinction = density * (1.0 + tree.attribute("hidden") * _hiding(tree, thick))
    lit = _solved if shot.settings.smoke.lighting == "solved" else _traced
    visible = lit(tree, shot, stage, _Smoke(extinction, thinner, albedo, even))
    shader = infrared.smoke(tree, shot, stage, visible, density)
    # A mix by 0 or 1 evaluates one side only, and more than half of all steps are outside of smoke.
    clear = tree.output("ShaderNodeVolumeAbsorption", {"Density": 0.0})
    tree.volume(tree.mix_shader(density > 0.5 * flow_frames.min_extinction(shot.scale), clear, shader))
    made.cycles.volume_sampling = "DISTANCE"
    made.cycles.emission_sampling = "NONE"
    return made


def _solved(tree: nodes.Tree, shot: Shot, stage: Stage, smoke: _Smoke) -> nodes.Value:
    """Smoke as emission: radiance from the light in its grids."""
    part, air = haze.fraction(tree, stage)
    light = sunlit.source(tree, shot, smoke.albedo, smoke.even)
    if glow := _glow(tree, shot, smoke.density):
        light = tree.vector("ADD", light, tree.vector("SCALE", *glow))
    emission = tree.add_shader(
        _black(tree, smoke.density), tree.emission(tree.mix_colour(part, light, air), smoke.density)
    )
    # Reflections in lakes count too. Other rays gather 0.02/255 of the example's picture from emission.
    path = tree.node("ShaderNodeLightPath")
    looks = tree.math("MAXIMUM", *(tree.pick(path, name) for name in ("Is Camera Ray", "Is Glossy Ray")))
    return tree.mix_shader(looks, _black(tree, smoke.thinner), emission)


def _traced(tree: nodes.Tree, shot: Shot, stage: Stage, smoke: _Smoke) -> nodes.Value:
    """Smoke whose scattering Cycles traces."""
    middle = tree.input("Inner Colour", _MIDDLE, "Albedo for light by way of other smoke", "Colour")
    part, air = haze.fraction(tree, stage)
    light = tree.emission(air, part * smoke.density)
    if glow := _glow(tree, shot, smoke.density):
        shine, bright = glow
        light = tree.add_shader(light, tree.emission(shine, bright * (1.0 - part) * smoke.density))
    scattered = tree.mix_colour(part, smoke.albedo, (0.0, 0.0, 0.0))
    detailed = tree.add_shader(material.smoke(tree, smoke.density, scattered, smoke.even), light)
    # Most steps belong to light rays through the smoke; one grid is enough for them.
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    return tree.mix_shader(camera, material.smoke(tree, smoke.thinner, middle, smoke.even), detailed)


def _hiding(tree: nodes.Tree, thick: nodes.Value) -> nodes.Value:
    """Factor on the extinction of hidden smoke; 0 where smoke is drawn thinner than it is, and hides less."""
    factor = tree.input(
        "Hidden Density", _HIDDEN, "Times that smoke no camera sees counts besides", "Density"
    )
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    return factor * camera * (thick > 0.99)


def _black(tree: nodes.Tree, density: nodes.Value) -> nodes.Value:
    return tree.output("ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.0, 0.0), "Density": density})


def _glow(tree: nodes.Tree, shot: Shot, density: nodes.Value) -> tuple[nodes.Value, nodes.Value] | None:
    """Colour and strength of the flames' light in smoke, where it is dark enough to be visible."""
    if exposure.darkness(shot, shot.frames.middle) <= 0.0:
        return None
    shine, bright = material.glow_inputs(tree, shot)
    return shine, tree.attribute("glow") * bright * material.glowing(density)
