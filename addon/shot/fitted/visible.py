"""How much of the front a camera shows: in the picture, not behind ground, and not behind much smoke."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from firetwin_core import lod
from numpy.typing import NDArray

from ..path import Path
from .front import Front, some

_INSIDE = 0.97  # of the picture's half-width and half-height; what is nearer to its edge does not count
_RADIUS = 1.0  # m of a place of the front
_PLACES = 160  # of the front at most that are looked at in each moment
_SOURCES = 32  # places whose smoke is followed
_RISE, _WIDE = 0.5, 0.4  # height and half-width of smoke over the way it has drifted (by eye)
_THIN = 0.3  # of the fire's size: smoke that has drifted n times as far is n times as thin
_STEPS, _NEAR = 14, 0.01  # places where smoke is looked for on a line of sight, from this part of it on
_THICK = 0.25  # of the fire's strength: behind fresh smoke of more, a place counts as hidden (by eye)

Array = NDArray[np.float64]


class Seen(NamedTuple):
    """What a camera shows of a front.

    Attributes
    ----------
    share
        0..1; 0 where there is no front.
    height
        Of its middle over that of the picture, in halves of the picture's height: -1 at its lower edge.
    horizon
        The same of the horizon.
    """

    share: float
    height: float
    horizon: float


class Visible:
    """What of a front is visible from where."""

    def __init__(self, front: Front) -> None:
        self.front = front

    @cached_property
    def _ground(self) -> lod.Occluder:
        ground = self.front.ground
        inner = slice(ground.fields.margin, -ground.fields.margin or None)
        return lod.Occluder(ground.floor()[inner, inner])

    def seen(self, view: Path, near: float = np.inf) -> Seen:
        """What a camera shows of the front in the moments looked at.

        Parameters
        ----------
        near
            Only the front within this distance of what it looks at counts, m.
        """
        front, shares, heights = self.front, [], [np.empty(0)]
        for number, frame in enumerate(front.frames):
            here = np.flatnonzero(front.moment == number)
            away = front.point[here, :2] - view.target[frame, :2]
            here = some(here[np.hypot(*away.T) <= near], _PLACES)
            if len(here):
                place = front.point[here]
                shown = self._shown(view, int(frame), number, place)
                shares.append(float(np.mean(shown)))
                heights.append(_height(view, int(frame), place[shown]))
        height = np.concatenate(heights)
        return Seen(
            float(np.mean(shares)) if shares else 0.0,
            float(np.median(height)) if len(height) else 0.0,
            _horizon(view),
        )

    def _shown(self, view: Path, frame: int, moment: int, place: Array) -> NDArray[np.bool_]:
        """Which places (n, 3) a camera shows."""
        seen = self.over_ground(view, frame, place)
        if view.perspective:
            seen[seen] = self.smoke(view.position[frame], place[seen], moment) < _THICK
        return seen

    def over_ground(self, view: Path, frame: int, place: Array) -> NDArray[np.bool_]:
        """Which places (n, 3) are in the picture of a frame (from 0) and not behind ground."""
        ground, eye = self.front.ground, view.position[frame]
        sight = lod.Sight(
            eye[None],
            view.rotation[frame][None],
            _INSIDE * view.halves[frame][None],
            parallel=not view.perspective,
            clear=bool(eye[2] > ground.up(eye[0], eye[1])[0]),
            ground=self._ground,
        )
        return lod.seen(place, np.full(len(place), _RADIUS), sight)

    def smoke(self, eye: Array, place: Array, moment: int) -> Array:
        """Part (n,) of the fire's strength at a moment whose smoke is before places (n, 3), seen from `eye`.

        Smoke of a place goes with the wind as a straight plume, and thins out on its way; without a wind it
        stands over the place.
        """
        front = self.front
        sources = some(np.flatnonzero(front.moment == moment), _SOURCES)
        if len(sources) == 0 or len(place) == 0:
            return np.zeros(len(place))
        power = front.power[sources] / max(float(front.power[sources].sum()), 1.0e-12)
        source, wind = front.point[sources], front.wind
        axis = np.array([*wind, _RISE]) if np.any(wind) else np.array([0.0, 0.0, 1.0])
        part = np.geomspace(_NEAR, 1.0, _STEPS)
        line = place + part[:, None, None] * (eye - place)  # (steps, n, 3)
        away = line[:, :, None] - source  # (steps, n, sources, 3)
        along = away @ axis / (axis @ axis)
        off = np.linalg.norm(away - along[..., None] * axis, axis=-1)
        hit = (along > 0.0) & (off < _WIDE * along + 0.5 * max(front.ground.cell))
        thick = np.minimum(_THIN * front.size / np.maximum(along * np.linalg.norm(axis), 1.0), 1.0)
        return np.where(hit, thick, 0.0).max(axis=0) @ power


def _height(view: Path, frame: int, place: Array) -> Array:
    """How high (n,) places (n, 3) in the picture are over its middle, in halves of its height."""
    local = (place - view.position[frame]) @ view.rotation[frame]
    ahead = -local[:, 2] if view.perspective else 1.0
    return local[:, 1] / ahead / view.halves[frame, 1]


def _horizon(view: Path) -> float:
    """How high the horizon is in the picture, in the mean of all frames; of a level one, hills are higher."""
    if not view.perspective:
        return np.inf
    down = np.arcsin(np.clip(view.rotation[:, 2, 2], -1.0, 1.0))
    return float(np.mean(np.tan(np.minimum(down, 1.5)) / view.halves[:, 1]))
