"""Inputs that the paths of all cameras of a shot share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from firetwin_core.run import Run

from ..frames import Frames
from ..sections.camera import CameraSettings


@dataclass(frozen=True)
class Filming:
    """Run, frames and cameras for which paths are made.

    Attributes
    ----------
    size
        Width and height of pictures, pixels, of cameras that do not set them.
    seed
        Random seed of vibration.
    """

    run: Run
    frames: Frames
    cameras: Sequence[CameraSettings]
    size: tuple[int, int]
    seed: int

    def resolution(self, camera: CameraSettings) -> tuple[int, int]:
        """Picture width and height of a camera, pixels."""
        return camera.resolution or self.size
