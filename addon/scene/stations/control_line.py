"""Control line of a suggested allocation: a curve on the ground for each division, for the 3D view alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.owned import Stage
from ...shot.shot import Shot
from . import routes

PART = "Allocation"
_COLOURS = {True: (0.02, 0.02, 0.02), False: (1.0, 0.1, 0.6)}
"""Linear colours of lines that are held and not held, by eye: black as on maps, pink against fire."""
_RADIUS = 40.0  # m, by eye: a line of two pixels in a view of 40 km
_ABOVE = 6.0  # m above the ground, assumed

Array = NDArray[np.float64]


def build(shot: Shot, stage: Stage, features: Sequence[dict[str, Any]]) -> list[bpy.types.Object]:
    """Build a curve for each `control_line` of GeoJSON features; earlier curves are removed.

    They are hidden in renders, because passes such as depth and masks do not have them.
    """
    collection = stage.part(PART)
    looks: dict[bool, bpy.types.Material] = {}
    built = []
    for each in features:
        about = each["properties"]
        if about["kind"] != "control_line":
            continue
        drawn = [routes.drape_line(shot, np.array(line)) for line in each["geometry"]["coordinates"]]
        lines = [line for line in drawn if len(line) > 1]
        if not lines:
            continue
        held = bool(about["held"])
        if held not in looks:
            looks[held] = _material(held)
        built.append(_curve(collection, about["division"], held, lines, looks[held]))
    return built


def _curve(
    collection: bpy.types.Collection,
    division: str,
    held: bool,
    lines: Sequence[Array],
    look: bpy.types.Material,
) -> bpy.types.Object:
    words = "Held" if held else "Not Held"
    data = bpy.data.curves.new(f"Firetwin Line {division}, {words}", "CURVE")
    data.dimensions, data.bevel_depth, data.bevel_resolution = "3D", _RADIUS, 0
    for line in lines:
        spline = data.splines.new("POLY")
        spline.points.add(len(line) - 1)
        raised = np.add(line, (0.0, 0.0, _ABOVE))
        spline.points.foreach_set("co", np.column_stack([raised, np.ones(len(line))]).ravel())
    data.materials.append(look)
    obj = owned.add(collection, f"Line {division}, {words}", data, f"line {division}")
    obj.color = (*_COLOURS[held], 1.0)  # in the solid view
    obj.hide_render = True
    return obj


def _material(held: bool) -> bpy.types.Material:
    name = "Firetwin Line Held" if held else "Firetwin Line Not Held"
    material, tree = nodes.material(name, _COLOURS[held])
    tree.surface(tree.emission(tree.combine(*_COLOURS[held])))
    return material
