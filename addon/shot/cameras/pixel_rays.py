"""What a camera's picture says of space: rays through its pixels, and points from their depth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import panorama

if TYPE_CHECKING:
    from ..settings.protocols import ShotView
    from .path import Path

SKY = 1.0e9  # m; what is deeper is no ground


def path_of(shot: ShotView, camera: str) -> Path:
    """The path of a camera."""
    return next(view for view in shot.paths if view.camera.name == camera)


def plane(view: Path, frame: int, height: int, width: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Tangents to the right and up (h, w) of the middles of pixels; metres without perspective."""
    across, up = view.halves[frame - 1]
    x = ((np.arange(width) + 0.5) / width * 2.0 - 1.0) * across
    y = (1.0 - (np.arange(height) + 0.5) / height * 2.0) * up
    return np.meshgrid(x, y)


def ranges(view: Path, frame: int, planar: NDArray) -> NDArray[np.float32]:
    """Distances (h, w) along lines of sight, m, from those along the camera's axis; the sky stays.

    Of a camera that sees all round these are one, and counted from between its eyes.
    """
    if view.around or not view.perspective:
        return planar
    x, y = plane(view, frame, *planar.shape)
    return np.where(planar < SKY, planar * np.sqrt(1.0 + x**2 + y**2), planar).astype(np.float32)


def points(view: Path, frame: int, planar: NDArray) -> NDArray[np.float64]:
    """Scene points (h, w, 3) m of depths along the camera's axis (h, w), m; NaN for the sky."""
    deep = np.where(planar < SKY, planar, np.nan).astype(np.float64)
    if view.around:
        return panorama.points(view, frame, deep)
    x, y = plane(view, frame, *planar.shape)
    far = deep if view.perspective else 1.0
    local = np.stack([x * far, y * far, -deep], axis=-1)
    return view.position[frame - 1] + local @ view.rotation[frame - 1].T
