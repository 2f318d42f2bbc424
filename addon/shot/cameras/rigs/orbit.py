"""Orbit camera: circles a point and looks at it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...schema import key
from ...schema.bounds import AIM, ANGLE, CLEARANCE, HEIGHT, LENGTH
from .. import flight, path
from ..path import Path
from ._lens import FOCAL_LENGTH, LensRig

if TYPE_CHECKING:
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place
    from ._view import View


@dataclass(frozen=True)
class Orbit(LensRig):
    """Perspective camera that circles a point and looks at it."""

    focal_length: float = key(35.0, "focal length", **FOCAL_LENGTH)
    latitude: float | None = key(
        None,
        "latitude of the point; default: the middle of the run",
        unit="degrees north",
        at_least=-90,
        at_most=90,
    )
    longitude: float | None = key(
        None,
        "longitude of the point; west is negative; default: the middle of the run",
        unit="degrees east",
        at_least=-180,
        at_most=180,
    )
    target_height: float = key(0.0, "target height above the terrain", **AIM)
    radius: float = key(3000.0, "radius of the circle", **LENGTH)
    height: float = key(1000.0, "camera height above the terrain at the point", **HEIGHT)
    speed: float = key(
        15.0,
        "speed along the circle in model time; negative is counter-clockwise",
        unit="m/s",
        at_least=-10_000,
        at_most=10_000,
    )
    bearing: float = key(180.0, "bearing of the camera from the point in the first frame", **ANGLE)
    clearance: float = key(50.0, "minimum height above the terrain under the circle", **CLEARANCE)

    @classmethod
    def from_view(cls, view: View) -> Orbit:
        """Circle around the centre of the view, starting at the eye."""
        latitude, longitude = view.aim
        return cls(
            **view.lens,
            latitude=latitude,
            longitude=longitude,
            radius=max(view.away, 1.0),
            height=max(view.rise, 1.0),
            bearing=(view.heading + 180.0) % 360.0,
        )

    def coordinates(self) -> list[Place]:
        """Centre of the circle."""
        if self.latitude is None or self.longitude is None:
            return []
        return [(("latitude",), self.latitude, self.longitude)]

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Circular path at its speed, raised smoothly above hills."""
        middle = ground.frame
        point = ground.point(
            middle.latitude if self.latitude is None else self.latitude,
            middle.longitude if self.longitude is None else self.longitude,
        )[0]
        elapsed = filming.frames.times - filming.frames.first
        angle = np.radians(self.bearing) + self.speed * elapsed / self.radius
        circle = np.stack([np.sin(angle), np.cos(angle), np.zeros(len(angle))], axis=-1)
        position = point + self.radius * circle + np.array([0.0, 0.0, self.height])
        position[:, 2] += path.eased(flight.short(ground, position, np.full(len(angle), self.clearance)))
        target = np.repeat(point[None] + np.array([0.0, 0.0, self.target_height]), len(angle), axis=0)
        half = self.half(camera, filming)
        return Path(camera, position, path.look(position, target), target, half, sensor=self.sensor_width)


RIG = Orbit
