"""Close-up smoke: a window in front of the camera with voxels a third as wide. Needs no Blender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..shot.shot import Shot

FINER = 3  # subdivisions of a coarse voxel
_NEAR = 60.0  # coarse voxels; beyond this distance from all cameras finer voxels add no visible detail
# Half the side of the square (coarse voxels), and share of it by which its centre is in front of the camera.
_HALF, _AHEAD = 40.0, 0.6
_FADE = 0.3  # fraction of the half side over which fine and coarse smoke are blended

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Window:
    """Square window from its corner of least x and y, in which smoke is painted on voxels of `voxel` m."""

    low: tuple[float, float]
    high: tuple[float, float]
    voxel: float

    def share(self, x: Array, y: Array) -> Array:
        """Compute the blend weight of the window's smoke at points: 0 outside and at the sides, 1 inside."""
        sides = (x - self.low[0], self.high[0] - x, y - self.low[1], self.high[1] - y)
        depth = np.minimum(np.minimum(*sides[:2]), np.minimum(*sides[2:]))
        return np.clip(depth / (_FADE * 0.5 * (self.high[0] - self.low[0])), 0.0, 1.0)


def window(shot: Shot, frame: int, voxel: float) -> Window | None:
    """Return a window before the eye nearest to fire if voxels of `voxel` m are too coarse there, else None.

    Other cameras that film the frame have no window.
    """
    filming = [
        (distance, number)
        for number, distance in enumerate(shot.nearest_fire)
        if frame - 1 in shot.filmed(shot.perspective_paths[number])
    ]
    distance, number = min(filming, default=(np.inf, 0))
    if shot.settings.smoke.voxel_size or distance > _NEAR * voxel:
        return None
    path, half = shot.perspective_paths[number], _HALF * voxel
    middle = (path.position[frame - 1] - _AHEAD * half * path.rotation[frame - 1, :, 2])[:2]
    low, high = middle - half, middle + half
    return Window(tuple(low.tolist()), tuple(high.tolist()), voxel / FINER)
