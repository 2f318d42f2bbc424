"""Material of solved smoke: the grids hold extinction; the material adds colour and light.

Smoke scatters light mostly forwards, so it attenuates about as much as thinner smoke with more isotropic
scattering (Joseph, Wiscombe and Weinman 1976, "The delta-Eddington approximation for radiative flux
transfer"). A single bounce therefore replaces many: for a ball of optical depth 16 in the sun its error is 11
to 16 % of the light against 24 bounces. One bounce of nearly isotropic scattering has an error of 13 to 54 %.
Camera rays, which determine outlines, use the full extinction.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.light import exposure, sky
from ...shot.shot import Shot
from ...smoke import flow_frames
from .. import haze, infrared
from . import material, sunlit

_PALE, _FRESH = (
    (0.70, 0.665, 0.62),
    (0.36, 0.315, 0.275),
)  # albedo of smoke from a grass fire, and from a crown fire's soot and char
_TUNED = 0.945, 1.9  # albedo for which the light in smoke was tuned, and factor on deviations from it
_OLD = np.array([0.995, 1.0, 1.005])  # albedo of aged haze and cloud, relative to green light
FORWARD = 0.6  # anisotropy of smoke (Reid et al. 2005: 0.5 to 0.65 in green light)
# anisotropy that remains after forward-scattered light is counted as unscattered
_ANISOTROPY = FORWARD / (1.0 + FORWARD)
_HIDDEN = 30.0  # factor on extinction in hidden smoke, so that camera rays, which go on to 1e-6, can end
_LIGHT = 0.5  # fraction of extinction for light rays: 0.7 by theory, less because bounces are omitted


@dataclass(frozen=True)
class _Smoke:
    """Extinction (1/m) for camera rays and for light rays, albedo and anisotropy."""

    density: nodes.Value
    thinner: nodes.Value
    albedo: nodes.Value
    even: nodes.Value


def build(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Smoke"."""
    look, tree = nodes.material("Firetwin Smoke")
    young = material.mix_colours(_PALE, _FRESH, shot.fire.smoke.dark)
    fresh = tree.input("Fresh Colour", young, "Albedo of fresh smoke: dark with soot, or pale", "Colour")
    old = tree.input(
        "Old Colour", tuple(_OLD * drawn_albedo(shot.fire.smoke.white)), "Albedo of aged haze", "Colour"
    )
    thick = tree.input("Density", 1.0, "Factor on how thick smoke is", "Density")
    even = tree.input("Anisotropy", _ANISOTROPY, "How much light is scattered forwards", "Light", -0.99, 0.99)
    density = tree.attribute("density") * thick
    albedo = tree.mix_colour(tree.attribute("fresh"), old, fresh)
    thinner = density * tree.input(
        "Light Density", _LIGHT, "Fraction of the smoke that attenuates light rays", "Light"
    )
    extinction = density * (1.0 + tree.attribute("hidden") * _hidden_factor(tree, thick))
    visible = _visible_light(tree, shot, stage, _Smoke(extinction, thinner, albedo, even))
    shader = infrared.select_smoke_shader(tree, shot, stage, visible, density)
    # A mix by 0 or 1 evaluates one side only, and more than half of all steps are outside of smoke.
    clear = tree.output("ShaderNodeVolumeAbsorption", {"Density": 0.0})
    tree.volume(tree.mix_shader(density > 0.5 * flow_frames.min_extinction(shot.scale), clear, shader))
    look.cycles.volume_sampling = "DISTANCE"
    look.cycles.emission_sampling = "NONE"
    return look


def drawn_albedo(white: float) -> float:
    """Return the albedo to draw smoke of a single-scattering albedo with.

    The three orders of scattering that are drawn were tuned for 0.945. In darker smoke they leave out the
    absorption of all further orders: thick smoke of asymmetry 0.6 reflects 0.43 of the light at an albedo of
    0.945, 0.32 at 0.9 and 0.26 at 0.86 (similarity relation of H. C. van de Hulst 1980, "Multiple Light
    Scattering"). The drawn albedo gives these ratios with light of sun and sky.
    """
    tuned, slope = _TUNED
    return tuned + slope * min(white - tuned, 0.0)


def _visible_light(tree: nodes.Tree, shot: Shot, stage: Stage, smoke: _Smoke) -> nodes.Value:
    """Shade smoke as emission: radiance from the light in its grids."""
    part, air = haze.fraction(tree, stage)
    light = sunlit.source_function(tree, shot, smoke.albedo, smoke.even)
    if glow := _glow(tree, shot):
        shine = tree.vector("MULTIPLY", smoke.albedo, tree.vector("SCALE", *glow))
        light = tree.vector("ADD", light, shine)
    emission = tree.add_shader(
        _absorb(tree, smoke.density), tree.emission(tree.mix_colour(part, light, air), smoke.density)
    )
    # Reflections in lakes count as well. Other rays gather 0.02/255 of the example's picture from emission.
    path = tree.node("ShaderNodeLightPath")
    looks = tree.math("MAXIMUM", *(tree.pick(path, name) for name in ("Is Camera Ray", "Is Glossy Ray")))
    return tree.mix_shader(looks, _absorb(tree, smoke.thinner), emission)


def _hidden_factor(tree: nodes.Tree, thick: nodes.Value) -> nodes.Value:
    """Return a factor on the extinction of hidden smoke; 0 if smoke is drawn thinner than it is."""
    factor = tree.input(
        "Hidden Density", _HIDDEN, "Factor on the density of smoke that no camera sees", "Density"
    )
    camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
    return factor * camera * (thick > 0.99)


def _absorb(tree: nodes.Tree, density: nodes.Value) -> nodes.Value:
    return tree.output("ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.0, 0.0), "Density": density})


def _glow(tree: nodes.Tree, shot: Shot) -> tuple[nodes.Value, nodes.Value] | None:
    """Return colour and strength of the flames' light in white smoke, if it is dark enough to be visible.

    Smoke with other smoke around it scatters more of it, as in `firetwin_core.volume.march`.
    """
    if exposure.darkness(shot, shot.frames.middle) <= 0.0:
        return None
    shine, bright = material.glow_inputs(tree, shot)
    share = 1.0 - tree.attribute("sky") * (1.0 - sky.THIN)
    return shine, tree.attribute("glow") * bright * share
