"""Lines of sight from a camera to flames, over terrain and between trees and bushes."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ...scene.forest.stand import CLEARING, Stand
from ...scene.forest.understorey import Instances
from ...shot.terrain.terrain import Terrain

_SAMPLES = 24  # places along a line of sight at which the terrain is compared
_CROWN = 0.17  # radius of a crown at its base, over the tree's height (assumed, on the wide side)
_ROUND = 0.5  # exponent of the outline of a crown, which is as wide as a pine's near its top (by eye)
_BASE, _TRUNK = 0.1, 0.012  # height of that base and radius of the trunk, over the tree's height (assumed)
_BUSH = 0.75  # radius of low plants and rocks over their height and width (assumed, on the wide side)
_LOW = 0.25  # m, height of plants that hide nothing
_OWN = 2.0, 0.3  # m, from a point: nearer trees and low plants do not hide it

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plants:
    """Trees and low plants around a fire, n of them.

    Attributes
    ----------
    place
        (n, 2) m in the scene.
    height, radius, trunk
        (n,) m: the radius at the base of the crown, and below it.
    round
        (n,) exponent of the crown's outline: 1, a cone; 0.5, a dome.
    base
        (n,) height of that base over the plant's height.
    near, own
        (n,) distances from a camera and from a seen point within which it hides nothing, m.
    """

    place: Array
    height: Array
    radius: Array
    trunk: Array
    round: Array
    base: Array
    near: Array
    own: Array

    @classmethod
    def of_stand(cls, stand: Stand) -> Plants:
        """Return the trees of a stand."""
        height = stand.height
        radius, trunk = _CROWN * height * stand.width, _TRUNK * height
        rest = (np.full(len(height), value) for value in (_ROUND, _BASE, CLEARING, _OWN[0]))
        return cls(stand.position[:, :2], height, radius, trunk, *rest)

    @classmethod
    def of_understorey(cls, low: Instances) -> Plants:
        """Return the low plants and rocks of at least `_LOW`."""
        low = low.take(np.flatnonzero(low.height >= _LOW))
        radius, nothing = _BUSH * low.height * low.width, np.zeros(len(low.height))
        return cls(
            low.position[:, :2],
            low.height,
            radius,
            nothing,
            nothing + 0.5,
            nothing,
            nothing,
            nothing + _OWN[1],
        )

    def before(self, eye: Array, points: Array) -> Plants:
        """Select plants that may hide points (m, 3) from a camera (3,): in a box along the lines of sight."""
        way, away = points[:, :2] - eye[:2], self.place - eye[:2]
        east, north = way.mean(axis=0) / max(float(np.hypot(*way.mean(axis=0))), 1.0e-6)
        turn = np.array([[east, -north], [north, east]])  # to metres along and across the mean line
        lines, plants, wide = way @ turn, away @ turn, self.radius[:, None]
        low, high = np.minimum(lines.min(axis=0), 0.0), np.maximum(lines.max(axis=0), 0.0)
        near = np.flatnonzero(((plants > low - wide) & (plants < high + wide)).all(axis=1))
        near = near[np.hypot(*away[near].T) > self.near[near]]
        return Plants(*(getattr(self, field.name)[near] for field in fields(self)))


def over_terrain(eye: Array, points: Array, ground: Terrain) -> NDArray[np.bool_]:
    """Return which points (m, 3) no terrain hides from a camera (3,), m in the scene."""
    part = np.linspace(0.02, 0.97, _SAMPLES)[:, None, None]
    way = eye + part * (points - eye)
    up = ground.up(way[..., 0].ravel(), way[..., 1].ravel()).reshape(way.shape[:2])
    clear: NDArray[np.bool_] = (way[..., 2] > up).all(axis=0)
    return clear


def between_plants(eye: Array, points: Array, ground: Terrain, plants: Plants) -> NDArray[np.bool_]:
    """Return which points (m, 3) no plant hides from a camera (3,), m in the scene."""
    if len(points) == 0 or len(plants.height) == 0:
        return np.ones(len(points), bool)
    plants = plants.before(eye, points)
    foot = ground.up(*plants.place.T)
    along = points[:, :2] - eye[:2]  # (m, 2)
    far = np.maximum(np.hypot(*along.T), 1.0e-6)[:, None]
    along = along / far
    away = plants.place - eye[:2]
    reached = along @ away.T  # (m, n) m, to the closest approach
    aside = np.abs(along[:, :1] * away[:, 1] - along[:, 1:] * away[:, 0])
    above = (eye[2] + reached / far * (points[:, 2] - eye[2])[:, None] - foot) / plants.height
    crown = plants.radius * np.clip((1.0 - above) / (1.0 - plants.base), 0.0, 1.0) ** plants.round
    radius = np.where(above < plants.base, plants.trunk, crown)
    before = (reached > 0.0) & (reached < far - plants.own) & (above < 1.0)
    hides: NDArray[np.bool_] = (before & (aside < radius)).any(axis=1)
    return ~hides
