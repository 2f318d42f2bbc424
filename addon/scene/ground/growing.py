"""What grows on the ground where it has not burned: canopy seen from afar, and the floor between trees."""

from __future__ import annotations

from dataclasses import dataclass

from ...blender import nodes
from ..grain import Grain
from .place import Place

_CROWNS_SEEN = (5000.0, 15_000.0)  # m from the camera at which crowns are full and gone
_SHADE, _BETWEEN = (0.009, 0.014, 0.008), (0.010, 0.015, 0.008)  # of dense clumps, and between crowns


@dataclass
class Crowns:
    """Crowns that are drawn by the ground, by cells some metres wide."""

    dark: nodes.Value  # 0..1, how deep between crowns
    tint: nodes.Value  # 0..1, from crown to crown
    alone: nodes.Value  # 1 where one stands amid brush or on rock


def crowns(tree: nodes.Tree, place: Place, size: float, groups: nodes.Value) -> Crowns:
    """Crowns in cells of `size` m. From afar one is less than a pixel: its mean is shown, without grain."""
    sharp = place.distance.ramp(*_CROWNS_SEEN, 1.0, 0.2)
    deep = tree.cells(place.position, size).smoothstep(0.34, 0.70)
    tint, lone, _ = tree.separate(tree.cells(place.position, size, "Color"))
    alone = (lone + (groups - 0.5) * 0.8) > 0.72
    return Crowns(tree.mix(sharp, 0.52, deep), tree.mix(sharp, 0.5, tint), tree.mix(sharp, 0.25, alone))


def far(tree: nodes.Tree, place: Place) -> tuple[nodes.Value, nodes.Value]:
    """Colour and height (m) where trees are part of the ground."""
    grain = place.grain
    fine, patch, groups = _fine(grain), _patch(grain), _groups(grain)
    seen = crowns(tree, place, 13.0, groups)
    cover = place.canopy + (patch - 0.5) * 0.9 + (groups - 0.5) * 1.6 + (fine - 0.5) * 0.6
    cover = tree.math("MAXIMUM", cover.smoothstep(0.0, 0.7), seen.alone * 0.85)
    canopy = tree.mix_colour(seen.dark, _canopy(tree, grain, seen.tint), _BETWEEN)
    open_ground = _open_ground(tree, place, fine, patch, seen.tint)
    return tree.mix_colour(cover, open_ground, canopy), cover * (1.0 - seen.dark) * 9.0 + fine * 2.0


def on_rock(tree: nodes.Tree, place: Place) -> tuple[nodes.Value, nodes.Value]:
    """Colour of lone trees on rock, and where they stand (0..1).

    They have cells of their own, so that these are worked out on rock alone.
    """
    seen = crowns(tree, place, 13.5, _groups(place.grain))
    lit = tree.mix_colour(0.5, _needles(tree, seen.tint), _SHADE)
    where = seen.alone * 0.8 * (1.0 - place.burned)
    return tree.mix_colour(seen.dark, lit, _BETWEEN), where


def close(tree: nodes.Tree, place: Place) -> tuple[nodes.Value, nodes.Value]:
    """Colour and height (m) where trees and brush stand there one by one."""
    fine, patch = _fine(place.grain), _patch(place.grain)
    tint = tree.separate(tree.cells(place.position, 13.0, "Color"))[0]
    open_ground = _open_ground(tree, place, fine, patch, tint)
    floor = (place.canopy + (patch - 0.5) * 0.5 + (fine - 0.5) * 0.4).smoothstep(0.0, 0.35)
    litter = tree.mix_colour(fine.smoothstep(0.3, 0.7), (0.019, 0.017, 0.010), (0.062, 0.050, 0.030))
    needles = tree.mix_colour(fine, (0.036, 0.025, 0.015), (0.078, 0.054, 0.033))
    beside = place.pixel.ramp(0.02, 0.20, 1.0, 0.0)  # brush is a colour but where it stands one by one
    litter = tree.mix_colour(beside, litter, needles)
    green = place.grain.noise(5.0, 4.0, 0.65).smoothstep(0.47, 0.60) * (1.0 - beside * 0.85)
    scrub = tree.mix_colour(green, litter, (0.024, 0.033, 0.014))
    return tree.mix_colour(floor, open_ground, scrub), fine * 2.0 + place.duff * 0.12


def _fine(grain: Grain) -> nodes.Value:
    return grain.noise(24.0, 4.0, 0.65)


def _patch(grain: Grain) -> nodes.Value:
    return grain.noise(420.0, 4.0, 0.6)


def _needles(tree: nodes.Tree, tint: nodes.Value) -> nodes.Value:
    """Colour of crowns in the sun."""
    deep = tree.input("Forest Dark", (0.026, 0.043, 0.016), "Darkest crowns of the far forest", "Forest")
    pale = tree.input("Forest Light", (0.072, 0.092, 0.036), "Lightest crowns of the far forest", "Forest")
    return tree.mix_colour(tint, deep, pale)


def _groups(grain: Grain) -> nodes.Value:
    return grain.noise(120.0, 3.0, 0.7)


def _canopy(tree: nodes.Tree, grain: Grain, tint: nodes.Value) -> nodes.Value:
    """Colour of crowns in the sun, stand by stand."""
    dark = _needles(tree, tint)
    stands = grain.noise(1500.0, 5.0, 0.6)
    dark = tree.mix_colour(
        stands.smoothstep(0.40, 0.62), dark, tree.mix_colour(0.6, dark, (0.034, 0.072, 0.026))
    )
    clumps = grain.noise(70.0, 3.0, 0.65).smoothstep(0.36, 0.64)
    return tree.mix_colour(clumps, tree.mix_colour(0.75, dark, _SHADE), dark)


def _open_ground(
    tree: nodes.Tree, place: Place, fine: nodes.Value, patch: nodes.Value, tint: nodes.Value
) -> nodes.Value:
    """Colour of meadows, soil and brush."""
    dry = place.elevation.ramp(500.0, 1500.0, 1.0, 0.0)
    meadow = tree.mix_colour(dry, (0.070, 0.070, 0.040), (0.110, 0.092, 0.052))
    soil = tree.mix_colour(fine, (0.115, 0.080, 0.050), (0.190, 0.140, 0.095))
    brush = place.grain.noise(34.0, 5.0, 0.7) + (patch - 0.5) * 0.7 + dry * -0.12
    shrub = tree.mix_colour(tint, (0.030, 0.038, 0.017), (0.052, 0.058, 0.028))
    open_ground = tree.mix_colour(fine.smoothstep(0.38, 0.62), meadow, tree.mix_colour(0.55, meadow, soil))
    return tree.mix_colour(brush.smoothstep(0.36, 0.52) * 0.92, open_ground, shrub)
