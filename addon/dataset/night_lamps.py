"""Lamps on the ground of a sample at night: street lamps and houses, which look like distant fire.

A lamp is at least `_WIDTH` pixels wide, at its drawn brightness, so that the rays of a picture meet it: the
lamps of a town several kilometres away are brighter than real ones.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..blender.owned import Stage
from ..scene.labels import town_lights
from ..shot.shot import Shot
from .draw import Draw

_HEIGHT, _MAST, _CANOPY = 6.0, 30.0, 0.01  # m; m amid trees, and kg/m2 from which there are trees
_REACH = np.geomspace(30.0, 15_000.0, 200)  # m, distances at which a ray is tested against the ground
_TRIES = 8  # rays for each lamp: rays to the sky and to places too close meet none
_WARM, _COOL, _COLD = (1.0, 0.62, 0.30), (0.85, 0.92, 1.0), 0.4  # sodium and white lamps; share of these
_LIGHT = 4.0, 40.0  # brightness relative to lit windows (assumed)
_WIDTH = 2.0  # pixels


def build(shot: Shot, stage: Stage, drawn: Draw) -> None:
    """Place the lamps of a sample in its view; remove the lamps of another sample."""
    collection = stage.part("Labels")
    if not drawn.lamps:
        return
    random = np.random.default_rng(drawn.random_seed("lamps"))
    centre = _seen_places(shot, random, drawn.lamps)
    cool = random.uniform(size=(len(centre), 1)) < _COLD
    low, high = np.log(_LIGHT)
    bright = np.exp(random.uniform(low, high, (len(centre), 1)))
    if len(centre):
        (view,) = shot.paths
        away = np.linalg.norm(centre - view.position[0], axis=1)
        size = np.maximum(town_lights.SIZE, 0.5 * _WIDTH * view.pixel * away)
        town_lights.place_lamps(shot, collection, centre, np.where(cool, _COOL, _WARM) * bright, size)


def _seen_places(shot: Shot, random: np.random.Generator, count: int) -> NDArray[np.float64]:
    """Find up to `count` places (n, 3), m, above ground that the camera sees."""
    (view,) = shot.paths
    across, up = random.uniform(-0.9, 0.9, (2, _TRIES * count))
    plane = np.column_stack([across * view.half[0], up * view.half[1], -np.ones(len(up))])
    along = plane @ view.rotation[0].T
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    way = view.position[0] + _REACH[:, None, None] * along
    ground = shot.bare_ground.up(way[..., 0].ravel(), way[..., 1].ravel()).reshape(way.shape[:2])
    below = way[..., 2] < ground
    hit = below.any(axis=0) & ~below[0]
    place = way[below.argmax(axis=0), np.arange(len(along))][hit][:count]
    canopy = shot.ground.sample(shot.ground.fields.canopy_fuel, *place[:, :2].T)
    place[:, 2] = shot.ground.up(*place[:, :2].T) + np.where(canopy > _CANOPY, _MAST, _HEIGHT)
    return place
