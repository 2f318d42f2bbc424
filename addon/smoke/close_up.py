"""Smoke right before a camera, painted on voxels a third as wide as the rest. Needs no Blender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..shot.shot import Shot

FINER = 3  # voxels along one of the rest's
_NEAR = 60.0  # voxels of the rest: fires farther from all cameras than this show no more of it
_HALF, _AHEAD = (
    40.0,
    0.6,
)  # voxels of the rest, half of the square's side; of that its middle is before a camera
_FADE = 0.3  # of half of the side, over which one goes over into the other

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Window:
    """A square from its corner of least x and y, in which smoke is painted on voxels of `voxel` m."""

    low: tuple[float, float]
    high: tuple[float, float]
    voxel: float

    def share(self, x: Array, y: Array) -> Array:
        """Part of the smoke at places that this draws: 0 outside and at the sides, 1 farther in."""
        sides = (x - self.low[0], self.high[0] - x, y - self.low[1], self.high[1] - y)
        depth = np.minimum(np.minimum(*sides[:2]), np.minimum(*sides[2:]))
        return np.clip(depth / (_FADE * 0.5 * (self.high[0] - self.low[0])), 0.0, 1.0)


def window(shot: Shot, frame: int, voxel: float) -> Window | None:
    """The square round the eyes of a frame, where smoke on voxels of `voxel` m is too coarse for them."""
    if shot.settings.smoke.voxel_size or shot.fire_distance > _NEAR * voxel:
        return None
    paths = [path for path in shot.perspective_paths if frame - 1 in shot.filmed(path)]
    if not paths:
        return None
    half = _HALF * voxel
    ahead = [path.position[frame - 1] - _AHEAD * half * path.rotation[frame - 1, :, 2] for path in paths]
    middle = np.mean(ahead, axis=0)[:2]
    low, high = middle - half, middle + half
    return Window(tuple(low.tolist()), tuple(high.tolist()), voxel / FINER)
