"""Sky for cameras that leave the atmosphere: it darkens with height and follows the Earth's limb.

The sky texture shows the sky from sea level, and nothing below the horizontal. With t the optical depth at
the zenith and m the air mass along a camera ray, in zeniths:

- below 3 km, a camera sees the texture times (1 - exp(-t m)) / (1 - exp(-t m0)), where m0 is the air mass of
  the same ray from sea level;
- above 15 km, a camera sees the haze's airlight times 1 - exp(-t m), also along rays that descend and pass
  over the Earth; in between, both are mixed.

This is single scattering in uniform light (Koschmieder 1924). t is the Rayleigh optical depth of the standard
atmosphere at 680, 550 and 440 nm (Bucholtz 1995, Applied Optics 34, 2765), with a scale height of 8 km. m is
the Chapman function in C. Schueler's approximation (GPU Pro 3, 2012, "An approximation to the Chapman
grazing-incidence function"). Other rays than the camera's see the sky from sea level, since it lights the
ground.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..blender.nodes import Tree, Value
from ..ellipsoid import MEAN_RADIUS
from . import curved_air
from .curved_air import Earth

_HEIGHT = 8000.0  # m, scale height of air
DEPTH = (0.043, 0.097, 0.242)
"""Rayleigh optical depth at the zenith in red, green and blue."""
_GRAZING = float(
    np.sqrt(0.5 * np.pi * MEAN_RADIUS / _HEIGHT)
)  # air mass (zeniths) along a horizontal ray to space
_HIGH = 50_000.0  # m; cameras below have the daylight at the fire
LOW, HIGH = 3_000.0, 15_000.0
"""Camera heights, m, between which both skies are mixed."""
SUN = "Toward Sun"


def attenuate_sky(
    tree: Tree, here: Earth, light: Value, airlight: Value, stars: Value | None = None
) -> Value:
    """Return the sky's light as a camera at any height sees it.

    Parameters
    ----------
    light
        The sky from sea level.
    stars
        Radiance of stars and moon without air; None by day, when no film records them.
    """
    along = tree.output("ShaderNodeTexCoord", name="Generated")
    place = here.scaled(tree, curved_air.camera_position(tree))
    away = tree.vector("LENGTH", place, name="Value")
    height = tree.math("MAXIMUM", (away - 1.0) * MEAN_RADIUS, 0.0)
    ray = tree.vector("NORMALIZE", here.scaled(tree, along, position=False))
    across = tree.vector("DOT_PRODUCT", place, ray, name="Value")
    sine = across / away
    own = (height * (-1.0 / _HEIGHT)).exp() * _air_to_space(tree.math("ABSOLUTE", sine))
    usual = _scattered_share(tree, _air_to_space(tree.math("MAXIMUM", sine, 0.0)))
    below = tree.vector("MULTIPLY", light, tree.vector("DIVIDE", _scattered_share(tree, own), usual))
    whole = tree.mix(sine < 0.0, own, _grazing_air(tree, away, sine, own))
    scattered = _scattered_share(tree, whole)
    above = tree.vector("MULTIPLY", airlight, scattered)
    shown = _mix(tree, height.smoothstep(LOW, HIGH), below, above)
    day = _daylight(tree, here, _lowest_point(tree, place, ray, across), height)
    shown = tree.vector("MULTIPLY", shown, tree.combine(day, day, day))
    if stars is not None:
        left = tree.vector("SUBTRACT", (1.0, 1.0, 1.0), scattered)
        behind = _mix(
            tree, height.smoothstep(LOW, HIGH), (0.0, 0.0, 0.0), tree.vector("MULTIPLY", stars, left)
        )
        shown = tree.vector("ADD", shown, behind)
    return _mix(tree, tree.output("ShaderNodeLightPath", name="Is Camera Ray"), light, shown)


def _air_to_space(sine: Value) -> Value:
    """Return the air mass (zeniths) along a ray that rises from sea level to space."""
    return _GRAZING / (sine * (_GRAZING - 1.0) + 1.0)


def _grazing_air(tree: Tree, away: Value, sine: Value, own: Value) -> Value:
    """Return the air mass (zeniths) along a ray that descends to its lowest point and rises again."""
    flat = tree.math("SQRT", tree.math("MAXIMUM", 1.0 - sine * sine, 0.0))
    lowest = tree.math("MAXIMUM", (away * flat - 1.0) * MEAN_RADIUS, 0.0)
    whole = (lowest * (-1.0 / _HEIGHT)).exp() * (2.0 * _GRAZING)
    return tree.math("MAXIMUM", whole - own, 0.0)


def _scattered_share(tree: Tree, air: Value) -> Value:
    """Return the share of uniform light that an air mass (zeniths) scatters: red, green and blue."""
    return tree.combine(*(1.0 - (air * -depth).exp() for depth in DEPTH))


def _lowest_point(tree: Tree, place: Value, ray: Value, across: Value) -> Value:
    """Return the scaled lowest point of a ray: the camera's position, if the ray rises."""
    fallen = tree.math("MINIMUM", across, 0.0)
    return tree.vector("SUBTRACT", place, tree.vector("MULTIPLY", ray, tree.combine(fallen, fallen, fallen)))


def _daylight(tree: Tree, here: Earth, point: Value, height: Value) -> Value:
    """Return daylight at a scaled position; near the ground the texture already includes it."""
    sun = tree.node("ShaderNodeCombineXYZ")
    sun.name = SUN
    _, up = here.upward(tree, point)
    day = curved_air.daylight(tree, up, tree.pick(sun))
    return tree.mix((height * (-1.0 / _HIGH)).exp(), day, 1.0)


def _mix(tree: Tree, factor: Value, a: Any, b: Any) -> Value:
    """Mix two vectors: a if factor is 0, b if it is 1."""
    return tree.output("ShaderNodeMix", {0: factor, 1: a, 2: b}, data_type="VECTOR", clamp_factor=True)
