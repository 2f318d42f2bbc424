"""A chase: a camera that goes along with the head of the fire and keeps it in the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import flight, path, targets
from ..bounds import AIM, ANGLE, CLEARANCE, HEIGHT, LENGTH
from ..path import Path
from ..schema import key
from ._lens import Lens

if TYPE_CHECKING:
    from ..ground import Ground
    from ..settings import Camera
    from ..shot import Shot
    from ._view import View


@dataclass(frozen=True)
class Chase(Lens):
    """In perspective, going along with the head of the fire."""

    distance: float = key(1500.0, "from the head, over the ground", **LENGTH)
    side: float = key(
        180.0, "where it is as the head sees it; 180: behind, 90: at its right, 0: before it", **ANGLE
    )
    height: float = key(400.0, "above the ground, about", **HEIGHT)
    target_height: float = key(100.0, "height above the ground of what it looks at", **AIM)
    clearance: float = key(50.0, "never nearer to the ground than this", **CLEARANCE)
    over_ridges: bool = key(True, "rise until it sees the head over the ridges")

    @classmethod
    def seeing(cls, view: View) -> Chase:
        """As far from the head, and as high above the ground, as the eye is from the middle of the view."""
        return cls(**view.lens, distance=max(view.away, 1.0), height=view.above)

    def path(self, camera: Camera, shot: Shot, ground: Ground) -> Path:
        """Beside the head, whose place and course are smooth over a fifth of the shot, and looking at it."""
        target = targets.follow("head", ground, shot.frames.times, self.target_height)
        away = targets.smoothed(flight.heading(target)) + np.radians(self.side)
        position = target + self.distance * np.stack([np.sin(away), np.cos(away), 0.0 * away], axis=-1)
        position[:, 2] = targets.smoothed(ground.up(position[:, 0], position[:, 1])) + self.height
        short = flight.short(ground, position, np.full(len(away), self.clearance))
        hidden = path.hidden(ground, position, target)
        position[:, 2] += path.eased(np.maximum(short, hidden) if self.over_ridges else short)
        return Path(
            camera,
            position,
            path.look(position, target),
            target,
            self.half(camera, shot),
            hidden=hidden,
            sensor=self.sensor_width,
        )


RIG = Chase
