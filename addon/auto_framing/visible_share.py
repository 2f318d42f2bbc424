"""Visible share of the front in a camera: in the picture, not occluded by terrain, and clear of smoke."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from firetwin_core import lod
from numpy.typing import NDArray

from ..shot.cameras.path import Path
from .front import MovingFront, some

_INSIDE = 0.97  # of the half width and half height; points nearer to the edge do not count
_RADIUS = 1.0  # m, radius of a front point
_PLACES = 160  # front points at most per time
# Rays of a picture that are tested for smoke near the camera, and their share of the distance to the target.
_RAYS, _NEAR = (7, 4), 0.5

Array = NDArray[np.float64]


class VisibleShare(NamedTuple):
    """Visibility of a front in a camera.

    Attributes
    ----------
    share
        Fraction of the front in the picture and not occluded by terrain, 0..1; 0 without a front.
    clear
        The same, weighted by the transmittance of the smoke.
    veil
        Mean opacity of smoke in the picture up to half of the distance to the target, 0..1.
    height
        Height of its centre above the picture's centre, in half heights: -1 at the lower edge.
    horizon
        The same for the horizon.
    """

    share: float
    clear: float
    veil: float
    height: float
    horizon: float


class Visible:
    """Visibility tests of a front."""

    def __init__(self, front: MovingFront) -> None:
        self.front = front

    @cached_property
    def _ground(self) -> lod.Occluder:
        ground = self.front.ground
        inner = slice(ground.fields.margin, -ground.fields.margin or None)
        return lod.Occluder(ground.floor()[inner, inner])

    def seen(self, view: Path, near: float = np.inf) -> VisibleShare:
        """Visible share of the front in a camera over the sampled times.

        Parameters
        ----------
        near
            Only the front within this distance of the camera's target counts, m.
        """
        front, shares, clear, veils, heights = self.front, [], [], [], [np.empty(0)]
        eye = view.position[front.frames]
        above_terrain = eye[:, 2] > front.ground.up(eye[:, 0], eye[:, 1])
        for number, frame in enumerate(front.frames):
            here = np.flatnonzero(front.moment == number)
            away = front.point[here, :2] - view.target[frame, :2]
            here = some(here[np.hypot(*away.T) <= near], _PLACES)
            if len(here):
                place = front.point[here]
                shown = self.over_ground(view, int(frame), place, bool(above_terrain[number]))
                depth = front.smoke.depth(number, view.position[frame], place[shown])
                shares.append(float(np.mean(shown)))
                clear.append(float(np.exp(-depth).sum()) / len(place))
                veils.append(self._veil(view, number))
                heights.append(_height(view, int(frame), place[shown]))
        height = np.concatenate(heights)
        return VisibleShare(
            float(np.mean(shares)) if shares else 0.0,
            float(np.mean(clear)) if clear else 0.0,
            float(np.mean(veils)) if veils else 0.0,
            float(np.median(height)) if len(height) else 0.0,
            _horizon(view),
        )

    def _veil(self, view: Path, moment: int) -> float:
        """Mean opacity of the smoke near a perspective camera at a sampled time."""
        if not view.perspective:
            return 0.0
        frame = self.front.frames[moment]
        x, y = (part.ravel() for part in np.meshgrid(*(np.linspace(-0.9, 0.9, count) for count in _RAYS)))
        wide, high = view.halves[frame]
        rays = np.stack([x * wide, y * high, -np.ones_like(x)], axis=-1)
        rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
        eye = view.position[frame]
        reach = _NEAR * float(np.linalg.norm(view.target[frame] - eye))
        depth = self.front.smoke.depth(moment, eye, eye + reach * rays @ view.rotation[frame].T)
        return float(np.mean(1.0 - np.exp(-depth)))

    def over_ground(self, view: Path, frame: int, place: Array, above_terrain: bool) -> NDArray[np.bool_]:
        """Return whether points (n, 3) are in the picture of a frame (from 0) and not occluded by terrain."""
        views = lod.ViewSet(
            view.position[frame][None],
            view.rotation[frame][None],
            _INSIDE * view.halves[frame][None],
            orthographic=not view.perspective,
            above_terrain=above_terrain,
            occluder=self._ground,
        )
        return lod.visible_mask(place, np.full(len(place), _RADIUS), views)


def _height(view: Path, frame: int, place: Array) -> Array:
    """Height (n,) of points (n, 3) above the picture's centre, in half heights."""
    local = (place - view.position[frame]) @ view.rotation[frame]
    ahead = -local[:, 2] if view.perspective else 1.0
    return local[:, 1] / ahead / view.halves[frame, 1]


def _horizon(view: Path) -> float:
    """Height of a level horizon in the picture, averaged over all frames; hills are higher."""
    if not view.perspective:
        return np.inf
    down = np.arcsin(np.clip(view.rotation[:, 2, 2], -1.0, 1.0))
    return float(np.mean(np.tan(np.minimum(down, 1.5)) / view.halves[:, 1]))
