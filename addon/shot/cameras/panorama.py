"""Equirectangular panoramas: pixel directions, mono or as over-under stereo (ODS)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .path import Path

Array = NDArray[np.float64]


def direction(bearing: Array, elevation: Array) -> Array:
    """Compute unit vectors (n, 3), right, up and back, from right bearings and elevations (n,), rad."""
    flat = np.cos(elevation)
    return np.stack([np.sin(bearing) * flat, np.sin(elevation), -np.cos(bearing) * flat], axis=-1)


def pixels(height: int, width: int, at: tuple[float, float] = (0.5, 0.5)) -> tuple[Array, Array]:
    """Bearings to the right and elevations (h, w), rad, at offsets `at` in pixels; the same for both eyes."""
    bearing = ((np.arange(width) + at[0]) / width * 2.0 - 1.0) * np.pi
    eye = 0.5 * np.pi - (np.arange(height // 2) + at[1]) / (height // 2) * np.pi
    bearings, elevations = np.meshgrid(bearing, np.tile(eye, 2))
    return bearings, elevations


def right(bearing: Array) -> Array:
    """Compute unit vectors (n, 3) from eye to eye, an observer's right, at bearings (n,), rad."""
    return np.stack([np.cos(bearing), 0.0 * bearing, np.sin(bearing)], axis=-1)


def points(view: Path, frame: int, far: Array) -> Array:
    """Scene points (h, w, 3), m, of a stereo panorama with ranges `far` (h, w), m from mid-eye.

    Each ray leaves its eye at a right angle to the baseline.
    """
    height, width = far.shape
    bearing, elevation = pixels(height, width)
    side = np.where(np.arange(far.shape[0])[:, None] < far.shape[0] // 2, -0.5, 0.5)
    eye = side * view.apart * merged(elevation)
    along = np.sqrt(np.maximum(far**2 - eye**2, 0.0))
    local = along[..., None] * direction(bearing, elevation) + eye[..., None] * right(bearing)
    return view.position[frame - 1] + local @ view.rotation[frame - 1].T


def merged(elevation: Array) -> Array:
    """Pole merging: fraction of eye separation left at an elevation, 1 up to 60 degrees and 0 from 75.

    As in Cycles: cos(pi / 2 (|elevation| - from) / (to - from)) between the two.
    """
    part = (np.abs(elevation) - _MERGE[0]) / (_MERGE[1] - _MERGE[0])
    return np.cos(0.5 * np.pi * np.clip(part, 0.0, 1.0))


_MERGE = np.radians([60.0, 75.0])
