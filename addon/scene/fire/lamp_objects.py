"""Lamps in the scene: point lights with keyframed energies, which represent the heat released."""

from __future__ import annotations

import bpy
import numpy as np

from ...blender import compat, nodes, owned
from ...shot.shot import Shot
from . import flame_light, lamps

COLOUR = (1.0, 0.32, 0.07)  # light of flames of 1300 K as displayed by AgX


def build(shot: Shot, collection: bpy.types.Collection) -> list[bpy.types.Object]:
    """Build "Firetwin Lamp 00" and so on in the collection of lamps; an empty list by day.

    Near a camera they are the light of smoke alone if flames there have their own light (see `flame_light`).
    """
    first, last = shot.frames.first, shot.frames.last
    if shot.settings.light.lamps == 0 or np.all(lamps.darkness(shot, np.linspace(first, last, 9)) == 0.0):
        return []
    nearest = flame_light.FAR_LAMPS if flame_light.applies(shot) else (0.0, 0.0)
    placed = lamps.place_lamps(shot, nearest, lamps.glow_share(shot))
    strength = lamps.LIGHT * lamps.darkness(shot, placed.time)
    frames = 1.0 + (placed.time - first) / (shot.frames.step or 1.0)
    objects = []
    for i, (position, radius) in enumerate(zip(placed.position, placed.radius, strict=True)):
        obj = _lamp(collection, f"Lamp {i:02d}", position, radius, frames, strength * placed.heat[:, i])
        # EEVEE would render six shadow maps for each
        obj.data.use_shadow = shot.settings.render.engine == "cycles"
        objects.append(obj)
    return objects


def _lamp(
    collection: bpy.types.Collection,
    name: str,
    position: lamps.Array,
    radius: float,
    frames: lamps.Array,
    energy: lamps.Array,
) -> bpy.types.Object:
    data = bpy.data.lights.new(f"{owned.ROOT} {name}", "POINT")
    data.color, data.energy = COLOUR, float(energy[0])
    data.shadow_soft_size = float(radius)
    data.volume_factor = 0.0  # EEVEE
    obj = owned.add(collection, name, data)
    obj.location, obj.lightgroup = position, nodes.FIRELIGHT
    obj.visible_camera = obj.visible_glossy = obj.visible_volume_scatter = False
    if len(frames) > 1 and np.ptp(energy) > 0.0:
        compat.animate(data, "energy", 0, frames, energy)
    return obj
