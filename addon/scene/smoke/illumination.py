"""Illumination for the ray march: sun, sky, flames and infrared, read from the scene's materials."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from firetwin_core import sensor, volume

from ...blender.owned import Stage, is_ours
from ...shot.fire import air_temperature
from ...shot.light import sky
from ...shot.sections.thermal import BANDS
from ...shot.shot import Shot
from ...smoke import hot_gas
from .. import haze, infrared
from .. import temperature as airs
from . import sunlit

_TABLE = air_temperature.TROPOPAUSE, 1900.0, 0.5
"""K, temperatures of air and flames in the radiance table, and their step; colder air has the first."""


def material(stage: Stage) -> bpy.types.Material | None:
    """Return the material of the scene's smoke."""
    objects = stage.root.all_objects
    volumes = [obj.data for obj in objects if obj.type == "VOLUME" and is_ours(obj)]
    return next((each.materials[0] for each in volumes if len(each.materials) and each.materials[0]), None)


def visible_light(stage: Stage, *, everywhere: bool = False) -> volume.Illumination:
    """Return the visible light in smoke, in the scene's current frame.

    Parameters
    ----------
    everywhere
        Scatter light equally in all directions, without haze, for smoke that is seen from everywhere.

    Raises
    ------
    KeyError
        The smoke's material was not built by `flow_material`.
    """
    group, tree = _group(stage)
    sun, around, toward = (tree.nodes[name] for name in sunlit.NODES)
    strength = _input_number(group, "Glow") if "Glow" in group.inputs else 0.0
    glow = [part * strength for part in _input_colour(group, "Glow Colour")] if strength else 3 * [0.0]
    return volume.Illumination(
        density=_input_number(group, "Density"),
        fresh=_input_colour(group, "Fresh Colour"),
        old=_input_colour(group, "Old Colour"),
        sun=[part * _input_number(group, "Sunlight") for part in sun.outputs[0].default_value[:3]],
        sky=[part * _input_number(group, "Skylight") for part in around.outputs[0].default_value[:3]],
        sun_direction=[socket.default_value for socket in toward.inputs],
        anisotropy=0.0 if everywhere else _input_number(group, "Anisotropy"),
        multiple_scattering=sunlit.OFTENER,
        glow=glow,
        thin=sky.THIN,
        **haze.illumination(
            stage, 0.0 if everywhere else _input_number(group, "Haze"), _input_colour(group, "Haze Tint")
        ),
    )


def light_without_smoke(stage: Stage) -> volume.Illumination:
    """Return the light of a scene without smoke: only its haze, in the scene's current frame."""
    black = 3 * [0.0]
    return volume.Illumination(
        density=0.0,
        fresh=black,
        old=black,
        sun=black,
        sky=black,
        sun_direction=[0.0, 0.0, 1.0],
        anisotropy=0.0,
        multiple_scattering=sunlit.OFTENER,
        glow=black,
        thin=sky.THIN,
        **haze.illumination(stage),
    )


def sun_direction(stage: Stage) -> list[float]:
    """Return the unit vector towards the sun, in the scene's current frame."""
    return [socket.default_value for socket in _group(stage)[1].nodes[sunlit.NODES[2]].inputs]


def light_ray_factor(stage: Stage) -> float:
    """Return the fraction of the smoke's extinction that attenuates light rays."""
    group, _ = _group(stage)
    return _input_number(group, "Density") * _input_number(group, "Light Density")


def extinction_factor(stage: Stage) -> float:
    """Return the factor on the smoke's extinction."""
    return _input_number(_group(stage)[0], "Density")


def infrared_arguments(shot: Shot, stage: Stage, frame: int) -> dict[str, Any]:
    """Return the arguments of `volume.march_infrared` for the air, and for smoke in the band."""
    low, high = BANDS[shot.settings.thermal.band]
    kelvin, elevation, corner, spacing = airs.field(shot, float(shot.frames.times[frame - 1]))
    first, last, step = _TABLE
    table = sensor.radiance(np.arange(first, last, step), (low, high))
    extinction = extinction_factor(stage) if material(stage) else 0.0
    return {
        "kelvin": kelvin,
        "elevation": elevation,
        "corner": corner,
        "spacing": spacing,
        "lapse": air_temperature.LAPSE,
        "radiance": table,
        "coldest": first,
        "kelvin_step": step,
        "absorption": infrared.absorption((low, high)) * extinction,
        "hot": hot_gas.layers(shot, frame) if extinction else [],
        "gas": hot_gas.ABSORPTION,
    }


def _group(stage: Stage) -> tuple[bpy.types.Node, bpy.types.NodeTree]:
    """Return the group node of the smoke's material, and its node tree."""
    smoke_material = material(stage)
    if smoke_material is None:
        raise KeyError("no smoke")
    tree = stage.evaluated(smoke_material).node_tree
    node = next(node for node in tree.nodes if node.type == "GROUP")
    return node, node.node_tree


def _input_number(group: bpy.types.Node, name: str) -> float:
    return float(group.inputs[name].default_value)


def _input_colour(group: bpy.types.Node, name: str) -> list[float]:
    return list(group.inputs[name].default_value)[:3]
