"""The stand: trees near the cameras round those of Algorithm 2, whose one tree per cell is no forest yet.

Invented in detail, faithful in the large: as many and as tall trees as the canopy fuel there calls for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...shot import noise
from ...shot.ground import Ground, bilinear
from ...shot.settings import Settings
from ...shot.shot import Shot
from . import models

LIMIT = 90_000  # trees; more than this and far ones are thinned
_TALLEST = 30.0  # m
_AROUND = 30.0  # m beside the view, from where trees still take light of the sky from what is in it
_YOUNG = 0.7  # part of the near trees that have a young one beside them
_YOUNG_DISTANCE = 900.0  # m
CLEARING = 40.0  # m round the cameras where no tree stands: these models are made for 60 m and more
_DENSE = 0.9  # kg/m2 of canopy fuel at which every place has a tree


@dataclass(frozen=True)
class Stand:
    """Trees of the stand, n of them.

    Attributes
    ----------
    position
        (n, 3) metres in the scene.
    height, rotation
        (n,) metres, radians.
    model
        (n,) number of the model in `models`.
    key
        (n, 2) integers that random choices for a tree hang on.
    distance
        (n,) metres from the nearest camera in all that is filmed.
    full, radius
        Within `full` metres of a camera no tree is left out, beyond `radius` all are.
    """

    position: NDArray[np.float64]
    height: NDArray[np.float64]
    rotation: NDArray[np.float64]
    model: NDArray[np.int64]
    key: NDArray[np.int64]
    distance: NDArray[np.float64]
    full: float
    radius: float

    def coverage(self, distance: NDArray) -> NDArray[np.float64]:
        """Part 0..1 of the wanted trees that is drawn at distances (m) from the cameras."""
        return _kept(distance, self.full) * noise.smoothstep(self.radius, 0.75 * self.radius, distance)


def grow(shot: Shot) -> Stand:
    """Place the stand within `stand_radius` of the cameras, where they look."""
    settings, ground = shot.settings, shot.ground
    spacing, radius = settings.forest.stand_spacing, settings.forest.stand_radius
    if not shot.near or radius <= 0.0:
        return _stand(ground, np.empty((0, 3)), np.empty((0, 2), np.int64), np.empty(0), 0.0, settings)
    blocks = _blocks(shot, radius)
    key = _lattice(blocks, spacing)
    jitter = np.stack([noise.uniform(key[:, 0], key[:, 1], settings.seed + 200 + k) for k in (0, 1)], axis=-1)
    place = (key + 0.5 + 0.85 * (jitter - 0.5)) * spacing
    canopy = ground.sample(ground.fields.canopy_fuel, place[:, 0], place[:, 1])
    clumps = noise.fractal(place[:, 0], place[:, 1], 90.0, 2, settings.seed + 210)
    chance = np.clip(canopy / _DENSE, 0.0, 1.0) * np.clip(0.85 + 0.6 * clumps, 0.25, 1.0)
    luck = noise.uniform(key[:, 0], key[:, 1], settings.seed + 202)
    kept = luck < chance
    place, key, luck, chance = place[kept], key[kept], luck[kept], chance[kept]
    position = np.column_stack([place, ground.up(place[:, 0], place[:, 1])])
    distance = shot.sights.distance(position)
    seen = shot.sights.seen(position, _TALLEST, reach=radius, margin=_AROUND, shadows=True)
    fade = noise.smoothstep(radius, 0.75 * radius, distance)
    seen &= (luck < chance * fade) & (distance > CLEARING)
    full = _full(distance[seen])
    seen &= luck < chance * fade * _kept(distance, full)
    return _with_young(
        ground, _stand(ground, position[seen], key[seen], distance[seen], full, settings), settings.seed
    )


def _with_young(ground: Ground, old: Stand, seed: int) -> Stand:
    """The stand with young trees under it, as many as the limit allows."""
    lot, turn, reach, grown = (noise.uniform(old.key[:, 0], old.key[:, 1], seed + 240 + k) for k in range(4))
    room = (LIMIT - len(lot)) / max(len(lot), 1)
    chosen = np.flatnonzero((lot < min(_YOUNG, room)) & (old.distance < _YOUNG_DISTANCE))
    angle, away = 2.0 * np.pi * turn[chosen], 3.5 + 4.0 * reach[chosen]
    east = old.position[chosen, 0] + away * np.cos(angle)
    north = old.position[chosen, 1] + away * np.sin(angle)
    model = models.FIRST_MODEL[0] + np.minimum((turn[chosen] * 400.0).astype(np.int64) % 4, 3)
    return Stand(
        np.concatenate([old.position, np.column_stack([east, north, ground.up(east, north)])]),
        np.concatenate([old.height, 4.0 + 7.0 * grown[chosen] ** 2]),
        np.concatenate([old.rotation, angle]),
        np.concatenate([old.model, model]),
        np.concatenate([old.key, old.key[chosen] + 10_000_019]),
        np.concatenate([old.distance, old.distance[chosen]]),
        old.full,
        old.radius,
    )


def _blocks(shot: Shot, radius: float) -> NDArray[np.int64]:
    """Corners (m, 2), in units of 200 m, of the blocks of ground that a camera sees within `radius`."""
    ground = shot.ground
    places = np.concatenate([view.position[shot.filmed(view)] for view in shot.near])[:, :2]
    low = np.floor((places.min(0) - radius) / 200.0).astype(int)
    high = np.ceil((places.max(0) + radius) / 200.0).astype(int)
    grid = np.stack(np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1])), axis=-1).reshape(
        -1, 2
    )
    centre = (grid + 0.5) * 200.0
    centre = np.column_stack([centre, ground.up(centre[:, 0], centre[:, 1])])
    return grid[shot.sights.seen(centre, 250.0, reach=radius, margin=_AROUND, shadows=True)]


def _lattice(blocks: NDArray[np.int64], spacing: float) -> NDArray[np.int64]:
    """Integer places (n, 2) of a lattice of `spacing` metres inside the blocks, each once."""
    per = int(np.ceil(200.0 / spacing)) + 1
    first = np.floor(blocks * 200.0 / spacing).astype(np.int64)
    steps = np.stack(np.meshgrid(np.arange(per), np.arange(per)), axis=-1).reshape(-1, 2)
    key = (first[:, None, :] + steps[None]).reshape(-1, 2)
    packed = np.unique((key[:, 0] << 32) + (key[:, 1] & 0xFFFFFFFF))
    low = packed & 0xFFFFFFFF
    return np.stack([packed >> 32, np.where(low >= 1 << 31, low - (1 << 32), low)], axis=-1)


def _kept(distance: NDArray, full: float) -> NDArray[np.float64]:
    """Chance to keep a tree: 1 up to `full` metres, beyond falling as the area of its picture."""
    return np.minimum((full / np.maximum(distance, 1.0)) ** 2, 1.0)


def _full(distance: NDArray) -> float:
    """Distance (m) up to which every tree can be kept, for at most LIMIT trees at these distances."""
    low, high = 1.0, max(float(distance.max(initial=1.0)), 1.0)
    if len(distance) <= LIMIT:
        return high
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _kept(distance, middle).sum() < LIMIT else (low, middle)
    return low


def _stand(
    ground: Ground,
    position: NDArray,
    key: NDArray[np.int64],
    distance: NDArray,
    full: float,
    settings: Settings,
) -> Stand:
    """Choose heights and models, by Algorithm 2's classes, with oaks in the foothills."""
    seed = settings.seed

    def random(use: int) -> NDArray[np.float64]:
        return noise.uniform(key[:, 0], key[:, 1], seed + 220 + use)

    row, column = ground.indices(*ground.geodetic(position[:, 0], position[:, 1]))
    canopy = bilinear(ground.fields.canopy_fuel, row, column)
    elevation = bilinear(ground.fields.elevation, row, column)
    size = np.where(canopy >= 1.6, 2, np.where(canopy >= 0.8, 1, 0))
    size = np.where(random(0) < 0.3, np.maximum(size - 1, 0), size)  # all ages stand together
    count = np.where(size == 2, 2, 4)
    first = np.array([models.FIRST_MODEL[k] for k in (0, 1, 2)])[size]
    model = first + np.minimum((random(1) * count).astype(np.int64), count - 1)
    fuel = np.clip(canopy / max(float(ground.fields.canopy_fuel.max()), 1.0e-6), 0.0, 1.0)
    normal = np.sqrt(-2.0 * np.log(np.maximum(random(2), 1.0e-9))) * np.cos(2.0 * np.pi * random(3))
    height = (8.0 + 14.0 * np.sqrt(fuel)) * np.array([0.75, 1.0, 1.2])[size] * np.exp(0.25 * normal)
    oak = random(4) < 0.75 * noise.smoothstep(1100.0, 600.0, elevation)
    model = np.where(oak, models.OAKS[0] + (random(5) < 0.5), model)
    height = np.where(oak, 0.5 * height, height)
    return Stand(
        position,
        np.clip(height, 4.0, _TALLEST),
        2.0 * np.pi * random(6),
        model,
        key,
        distance,
        full,
        settings.forest.stand_radius,
    )
