"""Live flames: crossed sheets along the front at all times of the shot.

A shader shows those that burn at the scene's time. They add light, so their order does not matter and one
mesh has them all. Vertex attributes are `card` (across -1..1, up 0..1, seed 0..1) and `burn` (arrival time
and residence in s, flame length in m).
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from .. import haze
from ..fire import flames
from ..fire.material import RAGGED, RISE, tear
from ..forest.stand import Stand
from ..glow import BODY, CLOSE, CORE, RIM, brightness
from . import viewers

SHARE = 0.06
"""Share of the scene's triangles."""
_SHEETS = 2
_BRIGHT = 0.4  # factor on the radiance: sheets add up (by eye)
_DIMMED = 0.3  # further factor close by
_HIDES = 0.5  # opacity of flames


def build(
    shot: Shot, stage: Stage, collection: bpy.types.Collection, budget: int, grown: Stand | None
) -> bpy.types.Object | None:
    """Build "Firetwin Live Flames", of at most `budget` triangles; None without flames."""
    if not shot.settings.fire.flames:
        return None
    points = flames.front_flames(shot, grown)
    kept = choose(viewers.distance(shot, points.position), budget // (2 * _SHEETS))
    if not len(kept):
        return None
    data = _mesh(points.take(kept), shot.wind)
    data.materials.append(_material(shot, stage))
    obj = owned.add(collection, "Live Flames", data)
    obj.visible_shadow = False
    return obj


def choose(away: NDArray[np.float64], count: int) -> NDArray[np.int64]:
    """Choose at most `count` of the flames at distances (n,), m: all nearby, then ever fewer."""
    if len(away) <= count:
        return np.arange(len(away))
    order = np.argsort(away, kind="stable")
    near = count // 2
    rest = order[near:]
    return np.sort(np.concatenate([order[:near], rest[:: -(-len(rest) // (count - near))]]))


def _mesh(points: flames.Points, wind: tuple[float, float]) -> bpy.types.Mesh:
    """Create crossed sheets of two triangles, which lean downwind."""
    east, north = np.array(wind) / max(float(np.hypot(*wind)), 1.0e-6)
    count = len(points.length)
    turn = np.pi * points.seed[:, None] + np.pi * np.arange(_SHEETS) / _SHEETS
    side = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=-1) * 0.5 * points.width[:, None, None]
    up = np.stack([np.sin(points.tilt) * east, np.sin(points.tilt) * north, np.cos(points.tilt)], axis=-1)
    top = (up * points.length[:, None])[:, None]
    foot = np.broadcast_to(points.position[:, None], side.shape)
    corners = np.stack([foot - side, foot + side, foot + side + top, foot - side + top], axis=2)
    faces = np.arange(4 * _SHEETS * count).reshape(-1, 4)
    data = create_mesh("Firetwin Live Flames", corners.reshape(-1, 3), faces, flat=True)
    card = np.zeros((count, _SHEETS, 4, 3))
    card[..., 0], card[..., 1] = (-1.0, 1.0, 1.0, -1.0), (0.0, 0.0, 1.0, 1.0)
    card[..., 2] = (points.seed[:, None] + np.arange(_SHEETS) * 0.37)[..., None] % 1.0
    burn = np.stack([points.arrival_time, points.residence, points.length], axis=-1)
    add_attribute(data, "card", "FLOAT_VECTOR", card)
    add_attribute(data, "burn", "FLOAT_VECTOR", np.broadcast_to(burn[:, None, None], card.shape))
    return data


def _material(shot: Shot, stage: Stage) -> bpy.types.Material:
    """Build "Firetwin Live Flames": tongues that rise while their point burns, and nothing otherwise."""
    material, tree = nodes.material("Firetwin Live Flames", (1.00, 0.25, 0.02))
    across, up, seed = tree.separate(tree.attribute("card", output="Vector"))
    arrival, residence, length = tree.separate(tree.attribute("burn", output="Vector"))
    time = nodes.model_time(tree)
    part = (time - arrival) / residence
    alive = (part > 0.0) * (part < 1.0)
    tall = part.ramp(0.0, 0.2, 0.25, 1.0) * part.ramp(0.6, 1.0, 1.0, 0.2)
    high = up / tall
    rise = (time - shot.frames.first) * RISE / tree.math("MAXIMUM", length, 4.0)
    place = tree.combine(across * 1.6 + seed * 431.0, high * 1.8 - rise, seed * 97.0 + time * 0.23)
    tongue = tree.noise(place, 1.0, 2.0, 0.6)
    narrow = tree.math("MAXIMUM", 1.0 - high, 0.0).power(0.65)
    body = 1.0 - tree.math("ABSOLUTE", across) / tree.math("MAXIMUM", narrow, 0.02)
    shape, hot, colour = tear(tree, body, tongue, high, RAGGED, (RIM, BODY, CORE))
    shape = shape * alive
    near = tree.output("ShaderNodeCameraData", name="View Distance").ramp(*CLOSE, _DIMMED, 1.0)
    air, _ = haze.fraction(tree, stage)
    bright = tree.input("Brightness", _BRIGHT * brightness(shot), "Radiance of the hottest part", "Light")
    strength = shape * (hot * 0.65 + 0.35) * near * (1.0 - air) * bright
    behind = 1.0 - shape * _HIDES
    clear = tree.output("ShaderNodeBsdfTransparent", {"Color": tree.combine(behind, behind, behind)})
    tree.surface(tree.add_shader(tree.emission(colour, strength), clear))
    material.surface_render_method = "BLENDED"
    material.use_transparency_overlap = True
    material.cycles.emission_sampling = "NONE"
    return material
