"""Illumination for the ray march: sun, sky, flames and infrared, read from the scene's materials."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from firetwin_core import sensor, volume

from ...blender.owned import Stage, ours
from ...shot.fire import air_temperature
from ...shot.light import sky
from ...shot.sections import BANDS
from ...shot.shot import Shot
from .. import haze, infrared
from .. import temperature as airs
from . import sunlit

_TABLE = 180.0, 360.0, 0.5  # K, of the air; and step of the radiance table's temperatures


def material(stage: Stage) -> bpy.types.Material | None:
    """Material of the scene's smoke."""
    objects = stage.root.all_objects
    volumes = [obj.data for obj in objects if obj.type == "VOLUME" and ours(obj)]
    return next((each.materials[0] for each in volumes if len(each.materials) and each.materials[0]), None)


def visible(stage: Stage) -> volume.Illumination:
    """Visible light in smoke, at the scene's frame.

    Raises
    ------
    KeyError
        The material of the smoke is not that of `flow_material`.
    """
    group, tree = _group(stage)
    sun, around, toward = (tree.nodes[name] for name in sunlit.NODES)
    air, extinction = haze.current_state(stage)
    strength = _number(group, "Glow") if "Glow" in group.inputs else 0.0
    glow = [part * strength for part in _colour(group, "Glow Colour")] if strength else 3 * [0.0]
    return volume.Illumination(
        density=_number(group, "Density"),
        fresh=_colour(group, "Fresh Colour"),
        old=_colour(group, "Old Colour"),
        sun=[part * _number(group, "Sunlight") for part in sun.outputs[0].default_value[:3]],
        sky=[part * _number(group, "Skylight") for part in around.outputs[0].default_value[:3]],
        sun_direction=[socket.default_value for socket in toward.inputs],
        anisotropy=_number(group, "Anisotropy"),
        multiple_scattering=sunlit.OFTENER,
        glow=glow,
        thin=sky.THIN,
        thick=sky.THICK,
        air=np.array(air) * np.array(_colour(group, "Haze Tint")),
        haze=extinction * _number(group, "Haze"),
        haze_height=sky.HAZE_HEIGHT,
    )


def toward_sun(stage: Stage) -> list[float]:
    """Unit vector to the sun, at the scene's frame."""
    return [socket.default_value for socket in _group(stage)[1].nodes[sunlit.NODES[2]].inputs]


def shading(stage: Stage) -> float:
    """Fraction of the smoke's extinction that attenuates light rays."""
    group, _ = _group(stage)
    return _number(group, "Density") * _number(group, "Light Density")


def thickness(stage: Stage) -> float:
    """Factor on the smoke's extinction."""
    return _number(_group(stage)[0], "Density")


def warm(shot: Shot, stage: Stage, frame: int) -> dict[str, Any]:
    """Arguments of `volume.march_infrared` for the air, and for smoke in the band."""
    low, high = BANDS[shot.settings.thermal.band]
    kelvin, elevation, corner, spacing = airs.field(shot, float(shot.frames.times[frame - 1]))
    first, last, step = _TABLE
    table = sensor.radiance(np.arange(first, last, step), (low, high))
    return {
        "kelvin": kelvin,
        "elevation": elevation,
        "corner": corner,
        "spacing": spacing,
        "lapse": air_temperature.LAPSE,
        "radiance": table,
        "coldest": first,
        "kelvin_step": step,
        "absorption": infrared.absorption((low, high)) * thickness(stage),
    }


def _group(stage: Stage) -> tuple[bpy.types.Node, bpy.types.NodeTree]:
    """Group node of the smoke's material, and its node tree."""
    smoke_material = material(stage)
    if smoke_material is None:
        raise KeyError("no smoke")
    tree = stage.evaluated(smoke_material).node_tree
    node = next(node for node in tree.nodes if node.type == "GROUP")
    return node, node.node_tree


def _number(group: bpy.types.Node, name: str) -> float:
    return float(group.inputs[name].default_value)


def _colour(group: bpy.types.Node, name: str) -> list[float]:
    return list(group.inputs[name].default_value)[:3]
