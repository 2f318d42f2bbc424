"""Infrared radiance of the ground: area-weighted mean of unburned, cooling, glowing and flaming ground."""

from __future__ import annotations

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.shot import Shot
from .. import infrared, temperature
from . import burn_scar
from .shading_inputs import GroundInputs

_UNEVEN = (90.0, 11.0), (0.45, 1.55)
"""Sizes of patches of heat in burned ground, m, and factors on its temperature excess: fuel and soil vary
(assumed; the mean is 1).
"""


def radiance(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    place: GroundInputs,
    rock: nodes.Value,
    lake: nodes.Value,
    normal: nodes.Value,
    burning: tuple[nodes.Value, nodes.Value],
) -> nodes.Value:
    """Return the radiance at the camera; `burning` are the area fractions 0..1 of flames and embers."""
    flaming, embers = burning
    embers = embers * burn_scar.glowing_fraction(tree, place)
    bare = bare_fraction(tree, place, rock)
    kelvin = surface_temperature(tree, shot, stage, place, rock, lake, normal, bare)
    emissivity = tree.mix(bare, infrared.NEEDLES, tree.mix(place.burned, infrared.GROUND, infrared.CHAR))
    emissivity = tree.mix(lake, tree.mix(rock, emissivity, infrared.STONE), infrared.LAKE)
    own = infrared.surface_radiance(tree, shot, stage, kelvin, emissivity)
    own = tree.mix(embers, own, infrared.surface_radiance(tree, shot, stage, temperature.EMBER))
    hot = flaming.ramp(0.0, 1.0, temperature.FLAME_LOW, temperature.FLAME_HIGH)
    own = tree.mix(flaming, own, infrared.surface_radiance(tree, shot, stage, hot))
    return infrared.radiance_at_camera(tree, shot, stage, own)


def bare_fraction(tree: nodes.Tree, place: GroundInputs, rock: nodes.Value) -> nodes.Value:
    """Return the fraction 0..1 of the ground without living crowns."""
    bare = tree.math("MAXIMUM", rock, place.canopy.ramp(0.0, 1.2, 1.0, 0.1))
    return tree.math("MAXIMUM", bare, place.burned)


def surface_temperature(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    place: GroundInputs,
    rock: nodes.Value,
    lake: nodes.Value,
    normal: nodes.Value,
    bare: nodes.Value,
) -> nodes.Value:
    """Return kinetic temperature (K) of ground and crowns, no flames or embers; `bare` is `bare_fraction`."""
    ambient = temperature.unburned_temperature(tree, shot, stage, place.elevation, normal, bare)
    heated = place.burned * (1.0 - rock) * _heat_variation(tree, place)
    kelvin = temperature.burned_temperature(tree, ambient, place.age, heated, place.residence)
    return tree.mix(lake, kelvin, temperature.WATER)


def _heat_variation(tree: nodes.Tree, place: GroundInputs) -> nodes.Value:
    """Return the factor on the temperature excess of burned ground, which differs from place to place."""
    large, small = (place.grain.noise(size * place.scale, 3.0, 0.6) for size in _UNEVEN[0])
    return (0.6 * large + 0.4 * small).ramp(0.3, 0.7, *_UNEVEN[1])
