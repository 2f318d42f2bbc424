"""Observed perimeters and detections in the scene: flat ribbons that glow by observation date."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.surface import observed
from ...shot.surface.observed import DrapedLine
from .. import glow, haze

_FRESH, _FADED = (0.02, 0.55, 1.0), (0.10, 0.22, 0.45)  # blue occurs neither in flames nor on the ground
_HEAT = {
    "intense": (1.0, 0.02, 0.65),
    "scattered": (0.42, 0.08, 1.0),
    "isolated": (0.75, 0.95, 1.0),
    "possible": (0.25, 0.40, 0.60),
}  # nor magenta, violet or white
LIGHT = 0.14  # radiance relative to flames
_DIM = 0.3  # remaining fraction when the next perimeter appears


def build(shot: Shot, stage: Stage, collection: bpy.types.Collection) -> bpy.types.Object | None:
    """Build "Firetwin Observed" if the settings name a file; it emits no light and casts no shadow.

    Its corners carry `seen_start`, `seen_fades` and `seen_end`, model times in s, and `seen_colour`.
    """
    lines = observed.lines(shot)
    if not lines:
        return None
    obj = owned.add(collection, "Observed", _mesh(lines, shot.settings.fire.observed_width))
    obj.data.materials.append(_material(shot, stage))
    show_to_camera_only(obj)
    return obj


def show_to_camera_only(obj: bpy.types.Object) -> None:
    """Make lines visible to camera rays only."""
    obj.visible_shadow = obj.visible_diffuse = obj.visible_glossy = obj.visible_volume_scatter = False


def _mesh(lines: list[DrapedLine], width: float) -> bpy.types.Mesh:
    ribbons = [closed_ribbon(line.points, width) for line in lines]
    starts = np.cumsum([0, *(len(each) for each in ribbons)])
    faces = [_faces(len(line.points)) + at for line, at in zip(lines, starts[:-1], strict=True)]
    corners = np.concatenate(faces)
    data = create_mesh("Firetwin Observed", np.concatenate(ribbons), corners, flat=True)
    for name in ("start", "fades", "end"):
        values = np.repeat([getattr(line, name) for line in lines], [len(each) for each in ribbons])
        add_attribute(data, f"seen_{name}", "FLOAT", values)
    colours = [(*_HEAT.get(line.kind, _FRESH), 1.0) for line in lines]
    values = np.repeat(np.array(colours, np.float32), [len(each) for each in ribbons], axis=0)
    add_attribute(data, "seen_colour", "FLOAT_COLOR", values)
    return data


def closed_ribbon(points: NDArray[np.float64], width: float) -> NDArray[np.float32]:
    """Return corners (2 n, 3) of a flat ribbon along a closed line (n, 3): left corners, then right ones."""
    here = np.arange(len(points))
    return ribbon_corners(points, np.roll(here, 1), np.roll(here, -1), width)


def ribbon_corners(
    points: NDArray[np.float64], before: NDArray[np.int64], after: NDArray[np.int64], width: float
) -> NDArray[np.float32]:
    """Return ribbon corners at points (n, 3) of closed lines, given the points before and after each (n,)."""
    along = (points[after] - points[before])[:, :2]
    length = np.maximum(np.hypot(*along.T), 1e-6)
    aside = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(along))]) / length[:, None]
    return np.concatenate([points + aside * width / 2, points - aside * width / 2]).astype(np.float32)


def _faces(count: int) -> NDArray[np.int64]:
    here = np.arange(count)
    there = np.roll(here, -1)
    return np.column_stack([here, there, there + count, here + count])


def _material(shot: Shot, stage: Stage) -> bpy.types.Material:
    material, tree = nodes.material("Firetwin Observed", _FRESH)
    time = nodes.model_time(tree)
    start, fades, end = (tree.attribute(f"seen_{name}") for name in ("start", "fades", "end"))
    colour = tree.attribute("seen_colour", output="Color")
    there = (1.0 - (start > time)) * (end > time)
    fresh = fades > time
    part, _air = haze.fraction(tree, stage)
    strength = (_DIM + fresh * (1.0 - _DIM)) * (1.0 - part) * (LIGHT * glow.brightness(shot))
    clear = tree.output("ShaderNodeBsdfTransparent", {"Color": (1.0, 1.0, 1.0)})
    line = tree.mix_shader(there, clear, tree.emission(tree.mix_colour(fresh, _FADED, colour), strength))
    tree.surface(nodes.switch(tree, nodes.THERMAL, nodes.over(tree, line), clear))
    material.cycles.emission_sampling = "NONE"
    return material
