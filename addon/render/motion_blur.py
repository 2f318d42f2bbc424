"""Motion blur of a moving camera, from a picture and its distances. Needs no Blender.

The picture at the middle of the exposure is displaced to several moments, by distances and the camera's path,
and averaged. Depth, temperatures and masks are not blurred. Surfaces hidden behind edges stay hidden, which
errs within the parallax of the exposure.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..shot.cameras import pixel_rays
from ..shot.cameras.path import Path

_MOST = 32  # moments
_FARTHEST = 1.0e8  # m; the sky
_SHARP = 0.25  # pixels; a shorter motion is not blurred

Array = NDArray[np.float32]


def blur(picture: Array, distance: Array, view: Path, frame: int, exposure: float) -> Array:
    """Blur a picture (h, w, n) by the camera's motion during an exposure that is centred on the frame.

    Parameters
    ----------
    distance
        (h, w) m, along the rays; far ones are sky.
    view
        Path of the camera. Only perspective cameras blur.
    exposure
        Frame intervals; 0: none.
    """
    if exposure == 0.0 or not view.perspective or view.around or len(view.position) == 1:
        return picture
    height, width = distance.shape
    x, y = pixel_rays.plane(view, frame, height, width)
    local = np.stack([x, y, -np.ones_like(x)], axis=-1)
    local *= (np.minimum(distance, _FARTHEST) / np.linalg.norm(local, axis=-1))[..., None]
    position, rotation = pose(view, frame - 1.0)
    points = position + local @ rotation.T
    scale = np.array([0.5 * width, -0.5 * height]) / view.halves[frame - 1]
    longest = max(
        float(np.abs(_moved(points, x, y, view, frame - 1 + part * exposure, scale)).max())
        for part in (-0.5, 0.5)
    )
    count = min(math.ceil(2.0 * longest), _MOST)
    if longest < _SHARP:
        return picture
    total = np.zeros_like(picture, dtype=np.float64)
    for number in range(count):
        time = frame - 1 + ((number + 0.5) / count - 0.5) * exposure
        total += _sampled(picture, -_moved(points, x, y, view, time, scale))
    return (total / count).astype(np.float32)


def apparent_distance(surface: Array, clear: Array, smoke: float) -> Array:
    """Return distances (h, w), m, by which a picture moves: of surfaces, and of smoke that hides them.

    Parameters
    ----------
    surface
        (h, w) m.
    clear
        (h, w) transmittance of smoke; rounding may raise it above 1.
    smoke
        Distance of the smoke, m.
    """
    share = np.clip(clear, 0.0, 1.0)
    return (1.0 / (share / np.maximum(surface, 1.0) + (1.0 - share) / max(smoke, 1.0))).astype(np.float32)


def pose(view: Path, time: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return position (3,) and rotation (3, 3) of a camera at a frame, counted from 0, with a fraction."""
    last = len(view.position) - 1
    low = int(np.clip(math.floor(time), 0, last - 1))
    part = time - low
    position, rotation = (
        (1.0 - part) * values[low] + part * values[low + 1] for values in (view.position, view.rotation)
    )
    left, _, right = np.linalg.svd(rotation)
    return position, left @ right


def _moved(
    points: NDArray[np.float64],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    view: Path,
    time: float,
    scale: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the displacement (h, w, 2) of points in the picture at another time, pixels right and down."""
    position, rotation = pose(view, time)
    local = (points - position) @ rotation
    deep = np.maximum(-local[..., 2], 1.0e-3)
    return np.stack([local[..., 0] / deep - x, local[..., 1] / deep - y], axis=-1) * scale


def _sampled(picture: Array, offset: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sample a picture (h, w, n), bilinearly, at an offset (h, w, 2) from each pixel; edges continue."""
    height, width = picture.shape[:2]
    across = np.clip(np.arange(width)[None, :] + offset[..., 0], 0.0, width - 1.0)
    down = np.clip(np.arange(height)[:, None] + offset[..., 1], 0.0, height - 1.0)
    i = np.minimum(across.astype(np.int64), max(width - 2, 0))
    j = np.minimum(down.astype(np.int64), max(height - 2, 0))
    u, v = (across - i)[..., None], (down - j)[..., None]
    above = (1.0 - u) * picture[j, i] + u * picture[j, i + 1]
    below = (1.0 - u) * picture[j + 1, i] + u * picture[j + 1, i + 1]
    return (1.0 - v) * above + v * below
