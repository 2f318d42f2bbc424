"""Compositor node group Regrade: grades flames, smoke, lights and haze of the layers of `passes.comp`.

With T = 1 - `smoke.A` and a density factor k, the transmittance of the smoke becomes T^k (Beer-Lambert law).
Surfaces are dimmed by T already, so they are multiplied by T^(k - 1). Smoke with the same source function S
along the ray has the radiance S (1 - T) (equation of radiative transfer; S. Chandrasekhar 1950, "Radiative
Transfer"), so it is multiplied by (1 - T^k) / (1 - T). The sum of the layers is the picture: they are dimmed
as after the operator *over* (T. Porter and T. Duff 1984, "Compositing Digital Images").

This is an approximation. Thinner smoke lets more sunlight into itself and onto the ground, and the layers do
not contain the opacity of the smoke in front of the flames. docs/delivery.md gives the error.

Haze h mixes surfaces at depth d with airlight by 1 - exp(-h d), as `scene.haze` does; h < 0 removes haze.
"""

from __future__ import annotations

from typing import Any

import bpy

from ..blender import nodes, owned
from ..blender.nodes import Tree, Value

NAME = "Firetwin Regrade"
MARK = "regrade"
LIGHTS = {
    "light_sun": ("Sun", "the sun"),
    "light_sky": ("Sky", "sky and haze"),
    "light_fire": ("Firelight", "flames on surfaces, and embers"),
}
LAYERS = (*LIGHTS, "fire", "smoke", "Alpha")
"""Inputs, and channels of `comp` as Blender's Image node names them."""
DEPTH = "Depth"
"""Input, and channel Z of `data` as Blender's Image node names it."""
LEAST = 2.0**-9
"""Least transmittance by which surfaces are brightened: four steps of a half-precision `smoke.A` near 1."""
THIN = 1.0e-3
"""Opacity below which (1 - T^k) / (1 - T) is replaced by its limit k."""
_BRIGHTEST = 4.0  # factor on surfaces at most, where haze is removed
_STOPS = 10.0
_AIRLIGHT = (0.27, 0.315, 0.38)  # `shot.light.sky` by day
_BLACK, _CLEAR = (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0)


def group() -> bpy.types.NodeTree:
    """Return the node group of this file, created on first use."""
    found = next((each for each in bpy.data.node_groups if owned.is_ours(each, MARK)), None)
    return found or _create()


def _create() -> bpy.types.NodeTree:
    tree = nodes.compositor(
        NAME,
        "Grades flames, smoke, lights and haze of the layers of the pass comp",
        {"Image": "NodeSocketColor"},
    )
    owned.mark(tree.node_tree, MARK)
    thin = _Smoke(tree)
    haze, air = _haze(tree)
    with tree.frame("Surfaces"):
        surfaces = _scale(tree, _lights(tree), thin.surfaces * haze)
        veil = _scale(tree, air, (1.0 - haze) * thin.transmittance)
    with tree.frame("Flames and smoke"):
        flames = _scale(
            tree,
            _layer(tree, "fire", "flames"),
            thin.flames * _stops(tree, "Fire Exposure", "flames", "Fire"),
        )
        tint = tree.input("Smoke Tint", (1.0, 1.0, 1.0, 1.0), "Factor on the colour of smoke", "Smoke")
        smoke = _scale(
            tree,
            tree.vector("MULTIPLY", thin.layer, tint),
            thin.light * _stops(tree, "Smoke Exposure", "smoke", "Smoke"),
        )
    total = surfaces
    for each in (veil, flames, smoke):
        total = tree.vector("ADD", total, each)
    tree.finish({"Image": total})
    return tree.node_tree


class _Smoke:
    """Layer of the smoke, and factors on layers by its density."""

    def __init__(self, tree: Tree) -> None:
        self.layer = _layer(tree, "smoke", "smoke, with its opacity as alpha", _CLEAR)
        density = tree.input("Smoke Density", 1.0, "Factor on the density of smoke", "Smoke", most=10.0)
        before = tree.input(
            "Smoke before Fire",
            1.0,
            "Share of the smoke in a pixel that is in front of its flames",
            "Smoke",
            most=1.0,
        )
        with tree.frame("Density of smoke"):
            alpha = tree.output("CompositorNodeSeparateColor", [self.layer], "Alpha").clamp()
            clear = 1.0 - alpha
            seen = tree.math("MAXIMUM", clear, LEAST)
            self.surfaces = seen.power(density - 1.0)
            self.flames = seen.power((density - 1.0) * before)
            self.transmittance = clear.power(density)
            known = alpha > THIN
            ratio = (1.0 - self.transmittance) / tree.math("MAXIMUM", alpha, THIN)
            self.light = ratio * known + density * (1.0 - known)


def _haze(tree: Tree) -> tuple[Value, Value]:
    """Return the factor of added haze on surfaces, and the radiance of thick haze."""
    about = "Haze to add, 1 / km of distance; below 0 it is removed. Needs Depth"
    amount = tree.input("Haze", 0.0, about, "Haze", -1.0, 10.0)
    air = tree.input("Haze Colour", _AIRLIGHT, "Radiance of thick haze", "Haze")
    share = tree.input(
        "Alpha", 1.0, "Share of surfaces in a pixel, not of sky: Alpha of comp", "Haze", most=1.0
    )
    depth = tree.input(DEPTH, 0.0, "Distance, m: Depth of the pass data", "Haze")
    with tree.frame("Haze"):
        left = tree.math("MINIMUM", (amount * depth * -1.0e-3).exp(), _BRIGHTEST)
        return 1.0 - share * (1.0 - left), air


def _lights(tree: Tree) -> Value:
    total = None
    for name, (label, of) in LIGHTS.items():
        light = _layer(tree, name, f"light of {of}")
        light = _scale(tree, light, _stops(tree, f"{label} Exposure", f"light of {of}", "Light"))
        total = light if total is None else tree.vector("ADD", total, light)
    assert total is not None
    return total


def _layer(tree: Tree, name: str, of: str, default: tuple[float, ...] = _BLACK) -> Value:
    return tree.input(name, default, f"Layer of comp: {of}", "Layers")


def _stops(tree: Tree, name: str, of: str, panel: str) -> Value:
    """Add an input in stops, and return its factor."""
    stops = tree.input(name, 0.0, f"Exposure of {of}, stops", panel, -_STOPS, _STOPS)
    return tree.math("POWER", 2.0, stops)


def _scale(tree: Tree, colour: Any, factor: Any) -> Value:
    return tree.output("ShaderNodeVectorMath", {"Vector": colour, "Scale": factor}, operation="SCALE")
