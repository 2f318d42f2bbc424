"""A satellite: a camera far above that looks straight down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..path import Path
from ..schema import Where, key
from . import Rig
from ._key import CameraKey, rising

if TYPE_CHECKING:
    from ..ground import Ground
    from ..settings import Camera
    from ..shot import Shot
    from . import Place

HEIGHT = 60_000.0  # m above the ground, over any smoke


@dataclass(frozen=True)
class Satellite(Rig):
    """Straight down and to scale, from above all smoke.

    It stands over the latitude and longitude of its first key, or over the middle of the run.
    """

    swath: float = key(56_000.0, "width of the picture on the ground", unit="m", above=0)
    keys: tuple[CameraKey, ...] = key((), "the first places it; without one it is over the middle of the run")

    def wrong(self) -> tuple[Where, str] | None:
        """Its moments rise."""
        return rising(self.keys)

    def places(self) -> list[Place]:
        """Where it stands."""
        return [(("keys", i, "latitude"), at.latitude, at.longitude) for i, at in enumerate(self.keys)]

    def path(self, camera: Camera, shot: Shot, ground: Ground) -> Path:
        """It stays where it is."""
        first = self.keys[0] if self.keys else ground.frame
        place = ground.point(first.latitude, first.longitude)
        count = shot.frames.count
        position = np.repeat(place + np.array([0.0, 0.0, HEIGHT]), count, axis=0)
        rotation = np.repeat(np.eye(3)[None], count, axis=0)
        width, height = shot.resolution(camera)
        half = 0.5 * self.swath
        target = np.repeat(place, count, axis=0)
        return Path(camera, position, rotation, target, (half, half * height / width), perspective=False)


RIG = Satellite
