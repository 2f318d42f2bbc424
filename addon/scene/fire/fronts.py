"""Fire fronts of comparison runs in the scene: glowing flat ribbons on the ground, one per model time."""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core.run import Run

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.surface import fronts
from .. import clock, glow, haze
from . import observed


def build(shot: Shot, stage: Stage, collection: bpy.types.Collection) -> None:
    """Build "Firetwin Front NAME" for each of the shot's comparison runs, if the settings ask for it.

    Corners carry `seen_start` and `seen_end`, model times in s; geometry nodes select the current ribbon.
    """
    if not shot.settings.fire.fronts:
        return
    colours = fronts.colours(shot.full)
    for name, run in shot.full.other_runs().items():
        obj = owned.add(collection, f"Front {name}", _mesh(shot, name, run))
        obj.data.materials.append(_material(shot, stage, name, colours[name]))
        obj.modifiers.new("Firetwin Front", "NODES").node_group = _select_current(shot, name)
        observed.show_to_camera_only(obj)


def _mesh(shot: Shot, name: str, run: Run) -> bpy.types.Mesh:
    front_lines = fronts.lines(shot, run)
    count = len(front_lines.points)
    before = np.empty(count, np.int64)
    before[front_lines.after] = np.arange(count)
    corners = observed.ribbon_corners(
        front_lines.points, before, front_lines.after, shot.settings.fire.observed_width
    )
    here = np.arange(count)
    faces = np.column_stack([here, front_lines.after, front_lines.after + count, here + count])
    data = create_mesh(f"Firetwin Front {name}", corners, faces)
    for which in ("start", "end"):
        values = np.tile(getattr(front_lines, which), 2).clip(-1e12, 1e12)
        add_attribute(data, f"seen_{which}", "FLOAT", values)
    return data


def _select_current(shot: Shot, name: str) -> bpy.types.NodeTree:
    """Build geometry nodes: ribbons of all times -> the ribbon of the current time."""
    tree, entry = nodes.geometry(f"Firetwin Front {name}")
    time = clock.geometry_time(tree, shot)
    start, end = (
        tree.output("GeometryNodeInputNamedAttribute", {"Name": f"seen_{which}"}, data_type="FLOAT")
        for which in ("start", "end")
    )
    other = tree.math("ADD", start > time, 1.0 - (end > time), clamp=True)
    tree.geometry(tree.output("GeometryNodeDeleteGeometry", {"Geometry": entry, "Selection": other > 0.5}))
    return tree.node_tree


def _material(shot: Shot, stage: Stage, name: str, colour: str) -> bpy.types.Material:
    shown = tuple((int(colour[at : at + 2], 16) / 255.0) ** 2.2 for at in (1, 3, 5))
    material, tree = nodes.material(f"Firetwin Front {name}", shown)
    part, _air = haze.fraction(tree, stage)
    strength = (1.0 - part) * (observed.LIGHT * glow.brightness(shot))
    clear = tree.output("ShaderNodeBsdfTransparent", {"Color": (1.0, 1.0, 1.0)})
    line = nodes.over(tree, tree.emission(shown, strength))
    tree.surface(nodes.switch(tree, nodes.THERMAL, line, clear))
    material.cycles.emission_sampling = "NONE"
    return material
