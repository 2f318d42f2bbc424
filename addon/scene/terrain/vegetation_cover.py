"""Vegetation cover of unburned ground: canopy from afar, and the floor between trees close by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...blender import nodes
from ..band_limited_noise import Grain
from ..forest.biomes import Colour, ShotBiome
from . import open_land as lands
from .shading_inputs import GroundInputs

_CROWNS_SEEN = (0.75, 2.3)  # widths of a crown in a pixel at which crowns have full contrast, and least
_MEADOW = ((0.070, 0.070, 0.040), (0.110, 0.092, 0.052))  # high and low meadows in the dry season
_SPRING = (0.062, 0.090, 0.030)  # all meadows when they are green
_TWIGS = (0.066, 0.054, 0.045)  # crowns without leaves, by eye
_TURNS = 0.5, 1.5  # deciduous crowns among the darkest and the lightest ones / the biome's share
_HUES = (0.64, 0.80, 0.98), (1.46, 1.24, 0.88)  # factors on the bluest and yellowest stands; by eye
_BROWN = (0.085, 0.060, 0.036)  # crowns that died before the fire
_LOST = 0.955  # tint from which a crown is brown
_ON_ROCK = 0.5  # m between crowns on rock


@dataclass
class Crowns:
    """Crowns in the ground's material, in cells some metres wide."""

    dark: nodes.Value  # 0..1, depth between crowns
    tint: nodes.Value  # 0..1, variation between crowns
    alone: nodes.Value  # 1 for a crown amid brush or on rock


def crowns(tree: nodes.Tree, place: GroundInputs, size: float, groups: nodes.Value) -> Crowns:
    """Return crowns in cells of `size` m; from afar they are filtered to their mean."""
    sharp = (place.pixel / size).ramp(*_CROWNS_SEEN, 1.0, 0.2)
    deep = tree.cells(place.position, size).smoothstep(0.34, 0.70)
    tint, lone, _ = tree.separate(tree.cells(place.position, size, "Color"))
    alone = (lone + (groups - 0.5) * 0.8) > 0.72
    return Crowns(tree.mix(sharp, 0.52, deep), tree.mix(sharp, 0.5, tint), tree.mix(sharp, 0.25, alone))


def distant_canopy(tree: nodes.Tree, place: GroundInputs, here: ShotBiome) -> tuple[nodes.Value, nodes.Value]:
    """Return colour and height (m) where trees are part of the ground."""
    grain = place.grain
    fine, patch, groups = _fine_noise(grain), _patch_noise(grain), _group_noise(grain)
    crown = crowns(tree, place, here.biome.crown, groups)
    cover = place.canopy + (patch - 0.5) * 0.9 + (groups - 0.5) * 1.6 + (fine - 0.5) * 0.6
    # Fuel patches on the apron are as large as its cells: noise turns them into edges of all sizes. Existing
    # noise is reused, since bump mapping evaluates each noise three times.
    cover = cover + (patch - 0.5) * (place.beyond * place.canopy.smoothstep(0.0, 0.2)) * 3.6
    hills = (patch - 0.5) * (place.beyond * place.relief)  # finer than its mesh
    if here.biome.open_land is None:
        cover = tree.math("MAXIMUM", cover.smoothstep(0.0, 0.7), crown.alone * 0.85)
    else:  # lone trees are too sparse to be visible
        cover = cover.smoothstep(0.0, 0.7) * place.canopy.smoothstep(0.01, 0.1)
    hue = (patch * 0.45 + groups * 0.55).smoothstep(0.36, 0.64)
    sunlit = _canopy_colour(tree, grain, crown.tint, hue, here)
    canopy = tree.mix_colour(crown.dark, sunlit, here.biome.between)
    if here.biome.open_land is not None:
        open_ground, height = lands.look(tree, place, here)
        wooded = cover * (1.0 - crown.dark) * (0.7 * here.biome.crown)
        height = wooded + (1.0 - cover) * height + fine * 0.5 + hills
        return tree.mix_colour(cover, open_ground, canopy), height
    open_ground = _open_ground_colour(tree, place, fine, patch, crown.tint, here)
    height = cover * (1.0 - crown.dark) * 9.0 + fine * 2.0 + hills
    return tree.mix_colour(cover, open_ground, canopy), height


def trees_on_rock(tree: nodes.Tree, place: GroundInputs, here: ShotBiome) -> tuple[nodes.Value, nodes.Value]:
    """Return the colour of lone trees on rock, and their coverage (0..1).

    They use separate cells, which are therefore evaluated on rock only.
    """
    biome = here.biome
    crown = crowns(tree, place, biome.crown + _ON_ROCK, _group_noise(place.grain))
    lit = tree.mix_colour(0.5, _crown_colour(tree, crown.tint, here), biome.shade)
    where = crown.alone * 0.8 * (1.0 - place.burned)
    return tree.mix_colour(crown.dark, lit, biome.between), where


def near_ground(tree: nodes.Tree, place: GroundInputs, here: ShotBiome) -> tuple[nodes.Value, nodes.Value]:
    """Return colour and height (m) of the ground where trees and brush are instanced."""
    fine, patch = _fine_noise(place.grain), _patch_noise(place.grain)
    height: nodes.Value | None = None
    if here.biome.open_land is None:
        tint = tree.separate(tree.cells(place.position, here.biome.crown, "Color"))[0]
        open_ground = _open_ground_colour(tree, place, fine, patch, tint, here)
    else:
        open_ground, height = lands.look(tree, place, here)
    floor = (place.canopy + (patch - 0.5) * 0.5 + (fine - 0.5) * 0.4).smoothstep(0.0, 0.35)
    litter = tree.mix_colour(fine.smoothstep(0.3, 0.7), *here.biome.litter)
    needles = tree.mix_colour(fine, (0.036, 0.025, 0.015), (0.078, 0.054, 0.033))
    brush_colour = place.pixel.ramp(0.02, 0.20, 1.0, 0.0)  # brush that is not instanced
    litter = tree.mix_colour(brush_colour, litter, needles)
    green = place.grain.noise(5.0, 4.0, 0.65).smoothstep(0.47, 0.60) * (1.0 - brush_colour * 0.85)
    scrub = tree.mix_colour(green, litter, here.biome.scrub)
    if height is None:
        height = fine * 2.0
    return tree.mix_colour(floor, open_ground, scrub), height + place.duff * 0.12


def _fine_noise(grain: Grain) -> nodes.Value:
    return grain.noise(24.0, 4.0, 0.65)


def _patch_noise(grain: Grain) -> nodes.Value:
    return grain.noise(420.0, 4.0, 0.6)


def _crown_colour(tree: nodes.Tree, tint: nodes.Value, here: ShotBiome) -> nodes.Value:
    """Return the colour of sunlit crowns."""
    dark, light = (
        seasonal_colour(here, colour, part) for colour, part in zip(here.biome.needles, _TURNS, strict=True)
    )
    deep = tree.input("Forest Dark", dark, "Darkest crowns of the far forest", "Forest")
    pale = tree.input("Forest Light", light, "Lightest crowns of the far forest", "Forest")
    return tree.mix_colour(tint, deep, pale)


def _group_noise(grain: Grain) -> nodes.Value:
    return grain.noise(120.0, 3.0, 0.7)


def _stand_noise(grain: Grain) -> nodes.Value:
    return grain.noise(1500.0, 5.0, 0.6)


def _canopy_colour(
    tree: nodes.Tree, grain: Grain, tint: nodes.Value, hue: nodes.Value, here: ShotBiome
) -> nodes.Value:
    """Return the colour of sunlit crowns: varied by crown, by stand (`hue`, 0..1) and by hillside."""
    dark = tree.mix_colour(tint > _LOST, _crown_colour(tree, tint, here), _BROWN)
    dark = tree.mix_colour(1.0, dark, tree.mix_colour(hue, *_HUES), "MULTIPLY")
    stands = _stand_noise(grain)
    dark = tree.mix_colour(stands.smoothstep(0.40, 0.62), dark, tree.mix_colour(0.6, dark, here.biome.stands))
    clumps = grain.noise(70.0, 3.0, 0.65).smoothstep(0.36, 0.64)
    return tree.mix_colour(clumps, tree.mix_colour(0.75, dark, here.biome.shade), dark)


def _open_ground_colour(
    tree: nodes.Tree,
    place: GroundInputs,
    fine: nodes.Value,
    patch: nodes.Value,
    tint: nodes.Value,
    here: ShotBiome,
) -> nodes.Value:
    """Return the colour of the Sierra's meadows, soil and brush."""
    dry = place.elevation.ramp(500.0, 1500.0, 1.0, 0.0)
    high, low = (mix_colours(here.green, colour, _SPRING) for colour in _MEADOW)
    meadow = tree.mix_colour(dry, high, low)
    soil = tree.mix_colour(fine, (0.115, 0.080, 0.050), (0.190, 0.140, 0.095))
    brush = place.grain.noise(34.0, 5.0, 0.7) + (patch - 0.5) * 0.7 + dry * -0.12
    shrub = tree.mix_colour(tint, (0.030, 0.038, 0.017), (0.052, 0.058, 0.028))
    open_ground = tree.mix_colour(fine.smoothstep(0.38, 0.62), meadow, tree.mix_colour(0.55, meadow, soil))
    return tree.mix_colour(brush.smoothstep(0.36, 0.52) * 0.92, open_ground, shrub)


def mix_colours(part: float, first: Colour, second: Colour) -> Colour:
    """Interpolate two colours linearly."""
    return tuple(np.add(first, part * np.subtract(second, first)).tolist())


def seasonal_colour(here: ShotBiome, colour: Colour, part: float = 1.0) -> Colour:
    """Return the colour of crowns, with `part` times the biome's deciduous crowns by season."""
    biome, leaves = here.biome, here.leaves
    turned = np.multiply(colour, 1.0 + leaves.turned * (np.array(biome.withered) - 1.0))
    bare = np.array(_TWIGS) * (sum(colour) / sum(np.add(*biome.needles) / 2.0))
    seen = turned + leaves.fallen * (bare - turned)
    return tuple(np.add(colour, min(part * biome.deciduous, 1.0) * (seen - colour)).tolist())
