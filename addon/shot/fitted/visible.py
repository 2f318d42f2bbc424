"""How much of the front a camera shows: in the picture, not behind ground, and not behind much smoke."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from firetwin_core import lod
from numpy.typing import NDArray

from ..path import Path
from .front import Front, some

_INSIDE = 0.97  # of the picture's half-width and half-height; what is nearer to its edge does not count
_RADIUS = 1.0  # m of a place of the front
_PLACES = 160  # of the front at most that are looked at in each moment
_SOURCES = 32  # places whose smoke is followed
_RISE = 0.35  # of smoke over the way it drifts, and as much its half-width: down to the ground (by eye)
_STEPS = 12  # places along a line of sight where smoke is looked for
_THICK = 0.5  # of the fire's strength: behind the smoke of more, a place counts as hidden

Array = NDArray[np.float64]


class Visible:
    """What of a front is visible from where."""

    def __init__(self, front: Front) -> None:
        self.front = front

    @cached_property
    def _ground(self) -> lod.Occluder:
        ground = self.front.ground
        inner = slice(ground.fields.margin, -ground.fields.margin or None)
        return lod.Occluder(ground.floor()[inner, inner])

    def share(self, view: Path, near: float = np.inf) -> float:
        """Share 0..1 of the front that a camera shows in the moments looked at; 0 where there is none.

        Parameters
        ----------
        near
            Only the front within this distance of what it looks at counts, m.
        """
        front = self.front
        shares = []
        for number, frame in enumerate(front.frames):
            here = np.flatnonzero(front.moment == number)
            away = front.point[here, :2] - view.target[frame, :2]
            here = some(here[np.hypot(*away.T) <= near], _PLACES)
            if len(here):
                shares.append(float(np.mean(self._shown(view, int(frame), number, front.point[here]))))
        return float(np.mean(shares)) if shares else 0.0

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

        Smoke of a place goes with the wind, rises `_RISE` of that way and is as wide to each side; without a
        wind it stands over it. What begins at the place itself does not count.
        """
        front = self.front
        sources = some(np.flatnonzero(front.moment == moment), _SOURCES)
        if len(sources) == 0 or len(place) == 0:
            return np.zeros(len(place))
        power = front.power[sources] / max(float(front.power[sources].sum()), 1.0e-12)
        source, wind = front.point[sources], front.wind
        axis = np.array([*wind, _RISE]) if np.any(wind) else np.array([0.0, 0.0, 1.0])
        part = (np.arange(_STEPS) + 0.5) / _STEPS
        line = eye + part[:, None, None] * (place - eye)  # (steps, n, 3)
        away = line[:, :, None] - source  # (steps, n, sources, 3)
        along = away @ axis / (axis @ axis)
        off = np.linalg.norm(away - along[..., None] * axis, axis=-1)
        hit = (along > 0.0) & (off < _RISE * along + 0.5 * max(front.ground.cell))
        return hit.any(axis=0) @ power
