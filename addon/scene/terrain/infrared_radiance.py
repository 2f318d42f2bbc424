"""Infrared radiance of the ground: area-weighted mean of unburned, cooling, glowing and flaming ground."""

from __future__ import annotations

from ...blender import nodes
from ...blender.owned import Stage
from ...shot.shot import Shot
from .. import infrared, temperature
from .shading_inputs import Place


def radiance(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    place: Place,
    rock: nodes.Value,
    lake: nodes.Value,
    normal: nodes.Value,
    burning: tuple[nodes.Value, nodes.Value],
) -> nodes.Value:
    """Return the radiance at the camera; `burning` are the area fractions 0..1 of flames and embers."""
    flaming, embers = burning
    bare = bare_fraction(tree, place, rock)
    kelvin = surface_temperature(tree, shot, stage, place, rock, lake, normal, bare)
    emissivity = tree.mix(bare, infrared.NEEDLES, tree.mix(place.burned, infrared.GROUND, infrared.CHAR))
    emissivity = tree.mix(lake, tree.mix(rock, emissivity, infrared.STONE), infrared.LAKE)
    own = infrared.surface_radiance(tree, shot, stage, kelvin, emissivity)
    own = tree.mix(embers, own, infrared.surface_radiance(tree, shot, stage, temperature.EMBER))
    hot = flaming.ramp(0.0, 1.0, temperature.FLAME_LOW, temperature.FLAME_HIGH)
    own = tree.mix(flaming.smoothstep(0.0, 0.5), own, infrared.surface_radiance(tree, shot, stage, hot))
    return infrared.radiance_at_camera(tree, shot, stage, own)


def bare_fraction(tree: nodes.Tree, place: Place, rock: nodes.Value) -> nodes.Value:
    """Return the fraction 0..1 of the ground without living crowns."""
    bare = tree.math("MAXIMUM", rock, place.canopy.ramp(0.0, 1.2, 1.0, 0.1))
    return tree.math("MAXIMUM", bare, place.burned)


def surface_temperature(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    place: Place,
    rock: nodes.Value,
    lake: nodes.Value,
    normal: nodes.Value,
    bare: nodes.Value,
) -> nodes.Value:
    """Return kinetic temperature (K) of ground and crowns, no flames or embers; `bare` is `bare_fraction`."""
    ambient = temperature.unburned_temperature(tree, shot, stage, place.elevation, normal, bare)
    kelvin = temperature.burned_temperature(
        tree, ambient, place.age, place.burned * (1.0 - rock), place.residence
    )
    return tree.mix(lake, kelvin, temperature.WATER)
