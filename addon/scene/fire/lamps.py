"""Lamps that stand for the light of the flames on ground and trees: a few dozen for the whole shot.

They stay where they are and change their energy by F-curves, as the heat near them comes and goes. Smoke gets
its light from the glow in its volume, so they leave smoke alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import compat
from ..project import Project
from . import clock, collections, heat, noise, sun
from .ground import Ground
from .paths import Path

# Degrees of the sun: under the lower one flames light the ground fully, over the upper one not at all. By day
# sunlight drowns their light by more than the few stops that exposures of day and night differ here.
NIGHT, DAY = -6.0, 6.0
COLOUR = (1.0, 0.32, 0.07)  # light of flames of 1300 K as AgX shows it
LIGHT = 6.0e-4  # W of light for each luminous W of heat by night; chosen by eye
_REACH = 9000.0  # m from a camera; light on ground farther away is not seen
_NEAR = 150.0  # m; nearer than this the distance from the camera does not make lamps closer to each other
_KEYS = 13  # at most this many moments of the shot
_BLOCK = 120.0  # m; heat this close together belongs to one lamp in any case
_ROUNDS = 12
_HEIGHTS, _RADII = (12.0, 60.0), (6.0, 60.0)  # m

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lamps:
    """n lamps at k moments.

    Attributes
    ----------
    time
        (k,) model time, s.
    position
        (n, 3) scene metres.
    radius
        (n,) m.
    heat
        (k, n) W that each lamp stands for: their sum is the luminous heat near the cameras.
    """

    time: Array
    position: Array
    radius: Array
    heat: Array


def build(
    project: Project, run: Run, ground: Ground, views: list[Path], parent: bpy.types.Collection
) -> list[bpy.types.Object]:
    """Build "Firetwin Lamp 00" and so on in the collection "Firetwin Lamps"; none by day."""
    collection = collections.fresh("Lamps", parent=parent)
    first, last = clock.window(project, run)
    if project.light.lamps == 0 or np.all(darkness(run, np.linspace(first, last, 9)) == 0.0):
        return []
    found = place(project, run, ground, views)
    strength = LIGHT * darkness(run, found.time)
    frames = 1.0 + (found.time - first) / (clock.step(project, run) or 1.0)
    made = []
    for i, (position, radius) in enumerate(zip(found.position, found.radius, strict=True)):
        thing = _lamp(collection, f"Lamp {i:02d}", position, radius, frames, strength * found.heat[:, i])
        thing.data.use_shadow = project.render.engine == "cycles"  # EEVEE would draw six maps for each
        made.append(thing)
    return made


def darkness(run: Run, times: Array) -> Array:
    """0 by day to 1 by night at model times (n,), s; it begins too gently to be seen."""
    return noise.smoothstep(DAY, NIGHT, [sun.at(run, float(time))[1] for time in times]) ** 2


def place(project: Project, run: Run, ground: Ground, views: list[Path]) -> Lamps:
    """Group the luminous heat of all moments near the cameras by weighted k-means (Lloyd 1982).

    Heat counts the more the nearer it is to a camera, so lamps stand close together where their places
    show. Each bit of heat is shared between the lamps near it, so that a passing front fades from one to
    the next.
    """
    times = moments(project, run)
    near = [view for view in views if view.perspective]
    model = heat.Heat(run, times[0], times[-1])
    parts = [_around(model.sources(float(t)).luminous(), near) for t in times]
    position = np.concatenate([part.position for part in parts])
    power = np.concatenate([part.power for part in parts])
    moment = np.repeat(np.arange(len(times)), [len(part.power) for part in parts])
    if not near or len(position) == 0:
        return Lamps(times, np.empty((0, 3)), np.empty(0), np.empty((len(times), 0)))
    distance = np.min([view.distance(position) for view in near], axis=0).astype(np.float64)
    power = power * np.clip((_REACH - distance) / (0.3 * _REACH), 0.0, 1.0)
    lit = np.flatnonzero(power > 0.0)
    position, power, moment, distance = position[lit], power[lit], moment[lit], distance[lit]
    weight = power / (distance**2 + _NEAR**2)
    none = np.full(len(weight), -1)
    whole = heat.lights(heat.Sources(position, weight, weight, none, none), _BLOCK, 1_000_000)
    centre = _centres(whole.position, whole.power, project.light.lamps, project.seed)
    gap = _gaps(position, centre)
    share = 1.0 / (gap + 25.0**2) ** 3
    share /= share.sum(axis=1, keepdims=True)
    total = np.zeros((len(times), len(centre)))
    np.add.at(total, moment, power[:, None] * share)
    spread = np.sqrt(
        (share * gap * weight[:, None]).sum(0) / np.maximum((share * weight[:, None]).sum(0), 1e-300)
    )
    above = np.clip(0.5 * spread, *_HEIGHTS)
    up = np.maximum(ground.up(centre[:, 0], centre[:, 1]), centre[:, 2]) + above
    return Lamps(times, np.column_stack([centre[:, :2], up]), np.clip(0.4 * spread, *_RADII), total)


def _around(sources: heat.Sources, near: list[Path]) -> heat.Sources:
    """Sources near the cameras, those close together merged."""
    kept = np.zeros(len(sources.power), bool)
    for view in near:
        low, high = view.position[:, :2].min(0) - _REACH, view.position[:, :2].max(0) + _REACH
        kept |= ((sources.position[:, :2] > low) & (sources.position[:, :2] < high)).all(axis=1)
    return heat.lights(sources.take(np.flatnonzero(kept)), _BLOCK, len(kept) * 4 + 1)


def moments(project: Project, run: Run) -> Array:
    """Model times that the lamps' energies are worked out for: model times of the run, and both ends."""
    first, last = clock.window(project, run)
    inside = run.times[(run.times > first) & (run.times < last)]
    if len(inside) > _KEYS - 2:
        inside = inside[np.linspace(0, len(inside) - 1, _KEYS - 2).round().astype(int)]
    return np.unique(np.concatenate([[first], inside, [last]]))


def _centres(position: Array, weight: Array, count: int, seed: int) -> Array:
    """At most `count` centres (n, 3) of weighted points, begun as k-means++ (Arthur, Vassilvitskii 2007)."""
    random = np.random.default_rng(seed)
    centre = position[[int(np.argmax(weight))]]
    nearest = _gaps(position, centre)[:, 0]
    while len(centre) < count:
        chance = np.cumsum(weight * nearest)
        if not chance[-1] > 0.0:
            break
        chosen = min(int(np.searchsorted(chance, random.random() * chance[-1])), len(position) - 1)
        centre = np.concatenate([centre, position[[chosen]]])
        nearest = np.minimum(nearest, _gaps(position, centre[-1:])[:, 0])
    for _ in range(_ROUNDS):
        member = np.argmin(_gaps(position, centre), axis=1)
        total = np.bincount(member, weight, len(centre))
        some = total > 0.0
        for axis in range(3):
            moved = np.bincount(member, weight * position[:, axis], len(centre))
            centre[some, axis] = moved[some] / total[some]
    return centre


def _gaps(position: Array, centre: Array) -> Array:
    """Squared distances (n, m) on the map, m2."""
    return (position[:, None, 0] - centre[None, :, 0]) ** 2 + (position[:, None, 1] - centre[None, :, 1]) ** 2


def _lamp(
    collection: bpy.types.Collection, name: str, position: Array, radius: float, frames: Array, energy: Array
) -> bpy.types.Object:
    data = bpy.data.lights.new(f"{collections.ROOT} {name}", "POINT")
    data.color, data.energy = COLOUR, float(energy[0])
    data.shadow_soft_size = float(radius)
    data.volume_factor = 0.0  # EEVEE
    thing = collections.add(collection, name, data)
    thing.location = position
    thing.visible_camera = thing.visible_glossy = thing.visible_volume_scatter = False
    if len(frames) > 1 and np.ptp(energy) > 0.0:
        compat.animate(data, "energy", 0, frames, energy)
    return thing
