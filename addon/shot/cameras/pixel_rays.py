"""Pixel rays: directions of a camera's pixels, and scene points from depth (unprojection)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import panorama

if TYPE_CHECKING:
    from .path import Path

SKY = 1.0e9  # m; larger depths are sky
_FARTHEST, _NEAREST = 1.0e8, 1.0e-3  # m; depth of the sky, and of points behind the camera, for motion


def path_of(paths: Iterable[Path], camera: str) -> Path:
    """Find the path of a camera by its name."""
    return next(view for view in paths if view.camera.name == camera)


def plane(view: Path, frame: int, height: int, width: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Image-plane coordinates (h, w) of pixel centres, right and up: tangents, or metres if orthographic."""
    across, up = view.halves[frame - 1]
    x = ((np.arange(width) + 0.5) / width * 2.0 - 1.0) * across
    y = (1.0 - (np.arange(height) + 0.5) / height * 2.0) * up
    right, above = np.meshgrid(x, y)
    return right, above


def ranges(view: Path, frame: int, planar: NDArray) -> NDArray[np.float32]:
    """Convert planar depth to range: distances (h, w) along rays, m. The sky stays.

    In a panorama depth is range already, measured from the centre of the eyes.
    """
    return np.where(planar < SKY, planar * _slant(view, frame, planar), planar).astype(np.float32)


def planar_depths(view: Path, frame: int, away: NDArray) -> NDArray[np.float32]:
    """Convert ranges (h, w), m, to planar depth; the inverse of `ranges`."""
    return np.where(away < SKY, away / _slant(view, frame, away), away).astype(np.float32)


def _slant(view: Path, frame: int, pixels: NDArray) -> NDArray[np.float64] | float:
    """Ratio (h, w) of range to planar depth."""
    if view.around or not view.perspective:
        return 1.0
    x, y = plane(view, frame, *pixels.shape)
    return np.sqrt(1.0 + x**2 + y**2)


def points(view: Path, frame: int, planar: NDArray) -> NDArray[np.float64]:
    """Unproject planar depth (h, w), m, to scene points (h, w, 3), m; NaN for the sky."""
    deep = np.where(planar < SKY, planar, np.nan).astype(np.float64)
    if view.around:
        return panorama.points(view, frame, deep)
    x, y = plane(view, frame, *planar.shape)
    far = deep if view.perspective else 1.0
    local = np.stack([x * far, y * far, -deep], axis=-1)
    return view.position[frame - 1] + local @ view.rotation[frame - 1].T


def motion(view: Path, frame: int, planar: NDArray, other: int) -> NDArray[np.float32]:
    """Compute how far pixels (h, w) of a flat picture have moved in another frame, in a static scene.

    Parameters
    ----------
    planar
        (h, w) planar depth, m.

    Returns
    -------
    (h, w, 2) pixels right and up.
    """
    height, width = planar.shape
    x, y = plane(view, frame, height, width)
    there = points(view, frame, np.minimum(planar, _FARTHEST))
    local = (there - view.position[other - 1]) @ view.rotation[other - 1]
    deep = np.maximum(-local[..., 2:], _NEAREST) if view.perspective else 1.0
    now = np.stack([x, y], axis=-1) / view.halves[frame - 1]
    then = local[..., :2] / deep / view.halves[other - 1]
    return ((then - now) * (0.5 * width, 0.5 * height)).astype(np.float32)
