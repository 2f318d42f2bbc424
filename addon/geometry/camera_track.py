"""Camera tracks: position, rotation and lens of a camera in frames of a film."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CameraTrack:
    """Track of a camera in f frames.

    Attributes
    ----------
    name
        Name of the camera.
    frames
        (f,) frame numbers, from 1.
    position
        (f, 3) scene positions, m.
    rotation
        (f, 3, 3) rotation matrices; their columns are the camera's right, up and back in the scene.
    half
        (f, 2) tangents of half the horizontal and vertical angles of view; half the width and height, m, of
        orthographic pictures; half the angles, radians, of panoramas.
    sensor
        Sensor width, mm.
    projection
        "perspective", "orthographic" or "panorama".
    clip
        (f, 2) near and far clip planes, m.
    """

    name: str
    frames: NDArray[np.int64]
    position: Array
    rotation: Array
    half: Array
    sensor: float
    projection: str
    clip: Array

    @property
    def focal(self) -> Array:
        """Focal lengths (f,) of a perspective camera, mm."""
        return 0.5 * self.sensor / self.half[:, 0]

    @property
    def aspect(self) -> float:
        """Height / width of the picture of a perspective or orthographic camera."""
        return float(self.half[0, 1] / self.half[0, 0])
