"""Lens and sensor of a perspective camera."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...schema import key
from ...schema.bounds import SENSOR as WIDTH
from ...schema.bounds import Bounds
from ..path import SENSOR
from . import Rig

if TYPE_CHECKING:
    from ...sections.camera import CameraSettings
    from . import Filming

FOCAL_LENGTH: Bounds = {"unit": "mm", "at_least": 1, "at_most": 5000}


@dataclass(frozen=True)
class LensRig(Rig):
    """Kind of camera with a lens."""

    focal_length: float = key(28.0, "focal length", **FOCAL_LENGTH)
    sensor_width: float = key(SENSOR, "sensor width; 36: full frame, 13.2: 1 inch, 6.4: small drone", **WIDTH)

    def half(self, camera: CameraSettings, filming: Filming) -> tuple[float, float]:
        """Tangents of half the angles of view, across and up; the picture is as wide as the sensor."""
        width, height = filming.resolution(camera)
        half = 0.5 * self.sensor_width / self.focal_length
        return half, half * height / width
