"""The sky of cameras that leave the atmosphere: it darkens with height, and lies about the Earth's limb.

The sky texture shows the sky from sea level, and nothing below the horizontal. With t the optical depth at
the zenith and m the air along a ray of the camera, in zeniths:

- an eye below 3 km sees the texture to the share of its air, (1 - exp(-t m)) / (1 - exp(-t m0)), m0 being m
  of the same ray from sea level;
- an eye above 15 km sees the airlight of the haze times 1 - exp(-t m), also along rays that fall and pass
  over the Earth; between, both are mixed.

This is single scattering in even light (Koschmieder 1924). t is Rayleigh's of the standard atmosphere at 680,
550 and 440 nm (Bucholtz 1995, Applied Optics 34, 2765), with a scale height of 8 km. m follows Chapman's
function in C. Schueler's approximation (GPU Pro 3, 2012, "An approximation to the Chapman grazing-incidence
function"). Rays that are not the camera's see the sky from sea level, as it lights the ground.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..blender.nodes import Tree, Value
from . import curved_air
from .curved_air import RADIUS, Earth

_HEIGHT = 8000.0  # m, scale height of air
_DEPTH = (0.043, 0.097, 0.242)
_GRAZING = float(np.sqrt(0.5 * np.pi * RADIUS / _HEIGHT))  # zeniths of air along a horizontal ray to space
_HIGH = 50_000.0  # m; lower eyes have the daylight of the fire's place
_LOW, _ABOVE = 3_000.0, 15_000.0  # m, heights of eyes between which the sky of the ground goes over
SUN = "Toward Sun"


def behind_air(tree: Tree, here: Earth, light: Value, airlight: Value) -> Value:
    """Light of the sky in a world's nodes: `light` from sea level, as a camera at any height sees it."""
    along = tree.output("ShaderNodeTexCoord", name="Generated")
    place = here.scaled(tree, curved_air.eye(tree))
    away = tree.vector("LENGTH", place, name="Value")
    height = tree.math("MAXIMUM", (away - 1.0) * RADIUS, 0.0)
    ray = tree.vector("NORMALIZE", here.scaled(tree, along, whole=False))
    across = tree.vector("DOT_PRODUCT", place, ray, name="Value")
    sine = across / away
    own = (height * (-1.0 / _HEIGHT)).exp() * _column(tree.math("ABSOLUTE", sine))
    usual = _scattered(tree, _column(tree.math("MAXIMUM", sine, 0.0)))
    below = tree.vector("MULTIPLY", light, tree.vector("DIVIDE", _scattered(tree, own), usual))
    whole = tree.mix(sine < 0.0, own, _through(tree, away, sine, own))
    above = tree.vector("MULTIPLY", airlight, _scattered(tree, whole))
    shown = _mixed(tree, height.smoothstep(_LOW, _ABOVE), below, above)
    day = _day(tree, here, _lowest(tree, place, ray, across), height)
    shown = tree.vector("MULTIPLY", shown, tree.combine(day, day, day))
    return _mixed(tree, tree.output("ShaderNodeLightPath", name="Is Camera Ray"), light, shown)


def _column(sine: Value) -> Value:
    """Air along a ray that rises from sea level to space, in zeniths."""
    return _GRAZING / (sine * (_GRAZING - 1.0) + 1.0)


def _through(tree: Tree, away: Value, sine: Value, own: Value) -> Value:
    """Air, in zeniths, along a ray that falls to its lowest point over the Earth and rises again."""
    flat = tree.math("SQRT", tree.math("MAXIMUM", 1.0 - sine * sine, 0.0))
    lowest = tree.math("MAXIMUM", (away * flat - 1.0) * RADIUS, 0.0)
    whole = (lowest * (-1.0 / _HEIGHT)).exp() * (2.0 * _GRAZING)
    return tree.math("MAXIMUM", whole - own, 0.0)


def _scattered(tree: Tree, air: Value) -> Value:
    """Share of even light that so much air (zeniths) scatters: red, green and blue."""
    return tree.combine(*(1.0 - (air * -depth).exp() for depth in _DEPTH))


def _lowest(tree: Tree, place: Value, ray: Value, across: Value) -> Value:
    """Scaled place where a ray is lowest: the eye's, if it rises."""
    fallen = tree.math("MINIMUM", across, 0.0)
    return tree.vector("SUBTRACT", place, tree.vector("MULTIPLY", ray, tree.combine(fallen, fallen, fallen)))


def _day(tree: Tree, here: Earth, point: Value, height: Value) -> Value:
    """Daylight at a scaled place; near the ground the texture has it already."""
    sun = tree.node("ShaderNodeCombineXYZ")
    sun.name = SUN
    _, up = here.upward(tree, point)
    day = curved_air.daylight(tree, up, tree.pick(sun))
    return tree.mix((height * (-1.0 / _HIGH)).exp(), day, 1.0)


def _mixed(tree: Tree, factor: Value, a: Any, b: Any) -> Value:
    """Vector: a where factor is 0, b where it is 1."""
    return tree.output("ShaderNodeMix", {0: factor, 1: a, 2: b}, data_type="VECTOR", clamp_factor=True)
