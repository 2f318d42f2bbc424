"""View of a camera on flames: what it can see, and distances at which the flame volume fades out.

Needs no Blender.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FADE = (0.8, 1.2)  # distances over the reach between which the field fades out

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ViewCone:
    """View of a camera, for culling: its rotation (3, 3), and the tangents of half its angles of view."""

    rotation: Array
    half: tuple[float, float]

    def sees(self, offset: Array, radius: float) -> NDArray[np.bool_]:
        """Return a mask (n,) of spheres of a radius (m) at offsets (n, 3) from the camera that it may see."""
        right, up, back = np.moveaxis(offset @ self.rotation, -1, 0)
        slack = [radius * np.hypot(1.0, half) for half in self.half]
        inside = (np.abs(right) < self.half[0] * -back + slack[0]) & (
            np.abs(up) < self.half[1] * -back + slack[1]
        )
        return inside | (np.linalg.norm(offset, axis=-1) < 2.0 * radius)
