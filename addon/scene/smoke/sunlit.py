"""Sunlit smoke: in-scattered light of sun and sky from the grids `sun` and `sky` of a solved flow.

Single-scattered sunlight follows the phase function of L. G. Henyey and J. L. Greenstein (1941, "Diffuse
radiation in the galaxy"). Multiple scattering is isotropic, with reduced extinction and a factor of albedo
per order, after M. Wrenninge, C. Kulla and V. Lundqvist (2013, "Oz: The Great and Volumetric"): a half and a
quarter of the optical depth are used.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes
from ...shot.light.sky import State
from ...shot.shot import Shot
from ..light.build import light_keyframes
from ..light.keyframes import add_keyframes

OFTENER = 0.5, 0.3  # weights relative to single scattering, from a ball and a plume against 24 and 32 bounces
_GROUND = 0.07  # albedo of forest and ash, which reflect light onto smoke from below (assumed)
NODES = _SUN, _SKY, _TOWARDS = "Sunlight", "Skylight", "Towards the Sun"


def source_function(tree: nodes.Tree, shot: Shot, albedo: nodes.Value, even: nodes.Value) -> nodes.Value:
    """Return the source function: radiance that smoke adds per optical depth along the camera ray."""
    sun, sky = (tree.attribute(name) for name in ("sun", "sky"))
    thinner = sun * sun
    brighter = tree.input("Sunlight", 1.0, "Factor on sunlight that smoke scatters", "Light")
    around = tree.input(
        "Skylight", 1.0, "Factor on light of the sky and the ground that smoke scatters", "Light"
    )
    once = thinner * thinner * _phase_function(tree, even)
    light = tree.vector("MULTIPLY_ADD", albedo, sun * OFTENER[1], thinner * OFTENER[0])
    light = tree.vector("MULTIPLY_ADD", albedo, light, once)
    sunlight = tree.vector("SCALE", tree.node("ShaderNodeRGB", name=_SUN), brighter / (4.0 * np.pi))
    light = tree.vector("MULTIPLY", light, sunlight)
    skylight = tree.vector("SCALE", tree.node("ShaderNodeRGB", name=_SKY), sky * around)
    light = tree.vector("MULTIPLY", albedo, tree.vector("ADD", light, skylight))
    _animate(shot, tree.node_tree)
    return light


def _phase_function(tree: nodes.Tree, even: nodes.Value) -> nodes.Value:
    """Return the phase function for light from the sun to the camera, 1 for isotropic scattering."""
    towards = tree.node("ShaderNodeCombineXYZ", name=_TOWARDS)
    cosine = tree.vector(
        "DOT_PRODUCT", towards, tree.output("ShaderNodeNewGeometry", name="Incoming"), name="Value"
    )
    square = even * even
    return (1.0 - square) * (1.0 + square + 2.0 * even * cosine).power(-1.5)


def _animate(shot: Shot, tree: bpy.types.NodeTree) -> None:
    """Keyframe the sun's and the sky's light over the shot."""
    frames, states = light_keyframes(shot)
    sun = np.array([s.power * np.array(s.colour) for s in states])
    sky = np.array([_mean_over_sphere(s) for s in states])
    opaque = np.ones((len(states), 1))
    for name, colours in ((_SUN, sun), (_SKY, sky)):
        add_keyframes(tree, f'nodes["{name}"].outputs[0].default_value', frames, np.hstack([colours, opaque]))
    towards = np.array([s.direction for s in states])
    for axis in range(3):
        add_keyframes(tree, f'nodes["{_TOWARDS}"].inputs[{axis}].default_value', frames, towards[:, axis])


def _mean_over_sphere(state: State) -> NDArray[np.float64]:
    """Return the mean radiance over the sphere: half sky, half ground."""
    sun = state.power * np.array(state.colour) * max(state.direction[2], 0.0) / np.pi
    return 0.5 * (state.around + _GROUND * (sun + state.sky_mean))
