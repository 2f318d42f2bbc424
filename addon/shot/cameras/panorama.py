"""Directions of pictures that hold all of them: equirectangular, for two eyes one above the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .path import Path

Array = NDArray[np.float64]


def direction(bearing: Array, elevation: Array) -> Array:
    """Unit vectors (n, 3), right, up and back, of bearings to the right and elevations (n,), rad."""
    flat = np.cos(elevation)
    return np.stack([np.sin(bearing) * flat, np.sin(elevation), -np.cos(bearing) * flat], axis=-1)


def pixels(height: int, width: int, at: tuple[float, float] = (0.5, 0.5)) -> tuple[Array, Array]:
    """Bearings to the right and elevations (h, w), rad, of places `at` in pixels, the same for both eyes."""
    bearing = ((np.arange(width) + at[0]) / width * 2.0 - 1.0) * np.pi
    eye = 0.5 * np.pi - (np.arange(height // 2) + at[1]) / (height // 2) * np.pi
    return np.meshgrid(bearing, np.tile(eye, 2))


def right(bearing: Array) -> Array:
    """Unit vectors (n, 3) to the right of an observer who looks to bearings (n,), rad: from eye to eye."""
    return np.stack([np.cos(bearing), 0.0 * bearing, np.sin(bearing)], axis=-1)


def points(view: Path, frame: int, far: Array) -> Array:
    """Scene points (h, w, 3) m of a stereo picture whose places are `far` (h, w) m from between the eyes.

    Lines of sight leave an eye at right angles to the way to the other eye.
    """
    bearing, elevation = pixels(*far.shape)
    side = np.where(np.arange(far.shape[0])[:, None] < far.shape[0] // 2, -0.5, 0.5)
    eye = side * view.apart * merged(elevation)
    along = np.sqrt(np.maximum(far**2 - eye**2, 0.0))
    local = along[..., None] * direction(bearing, elevation) + eye[..., None] * right(bearing)
    return view.position[frame - 1] + local @ view.rotation[frame - 1].T


def merged(elevation: Array) -> Array:
    """Part of their distance that the eyes keep: all up to 60 degrees, none from 75 on, as Blender has it.

    Cycles: cos(pi / 2 (|elevation| - from) / (to - from)) between the two.
    """
    part = (np.abs(elevation) - _MERGE[0]) / (_MERGE[1] - _MERGE[0])
    return np.cos(0.5 * np.pi * np.clip(part, 0.0, 1.0))


_MERGE = np.radians([60.0, 75.0])
