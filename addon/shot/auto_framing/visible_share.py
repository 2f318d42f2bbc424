"""How much of the front a camera shows: in the picture, not behind ground, and what of that smoke hides."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from firetwin_core import lod
from numpy.typing import NDArray

from ..cameras.path import Path
from .front import Front, some

_INSIDE = 0.97  # of the picture's half-width and half-height; what is nearer to its edge does not count
_RADIUS = 1.0  # m of a place of the front
_PLACES = 160  # of the front at most that are looked at in each moment

Array = NDArray[np.float64]


class VisibleShare(NamedTuple):
    """What a camera shows of a front.

    Attributes
    ----------
    share
        Of the front that is in the picture and not behind ground, 0..1; 0 where there is no front.
    clear
        The same, each place counting as much as smoke lets through of its light, were plumes straight.
    height
        Of its middle over that of the picture, in halves of the picture's height: -1 at its lower edge.
    horizon
        The same of the horizon.
    """

    share: float
    clear: float
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

    def seen(self, view: Path, near: float = np.inf) -> VisibleShare:
        """What a camera shows of the front in the moments looked at.

        Parameters
        ----------
        near
            Only the front within this distance of what it looks at counts, m.
        """
        front, shares, clear, heights = self.front, [], [], [np.empty(0)]
        for number, frame in enumerate(front.frames):
            here = np.flatnonzero(front.moment == number)
            away = front.point[here, :2] - view.target[frame, :2]
            here = some(here[np.hypot(*away.T) <= near], _PLACES)
            if len(here):
                place = front.point[here]
                shown = self.over_ground(view, int(frame), place)
                depth = front.plumes[number].depth(view.position[frame], place[shown])
                shares.append(float(np.mean(shown)))
                clear.append(float(np.exp(-depth).sum()) / len(place))
                heights.append(_height(view, int(frame), place[shown]))
        height = np.concatenate(heights)
        return VisibleShare(
            float(np.mean(shares)) if shares else 0.0,
            float(np.mean(clear)) if clear else 0.0,
            float(np.median(height)) if len(height) else 0.0,
            _horizon(view),
        )

    def over_ground(self, view: Path, frame: int, place: Array) -> NDArray[np.bool_]:
        """Which places (n, 3) are in the picture of a frame (from 0) and not behind ground."""
        ground, eye = self.front.ground, view.position[frame]
        views = lod.ViewSet(
            eye[None],
            view.rotation[frame][None],
            _INSIDE * view.halves[frame][None],
            orthographic=not view.perspective,
            above_terrain=bool(eye[2] > ground.up(eye[0], eye[1])[0]),
            occluder=self._ground,
        )
        return lod.visible_mask(place, np.full(len(place), _RADIUS), views)


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
