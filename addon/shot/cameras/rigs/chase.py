"""Chase camera: follows the head of the fire and keeps it in the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...schema import key
from ...schema.bounds import AIM, ANGLE, CLEARANCE, HEIGHT, LENGTH
from .. import flight, path, targets
from ..path import Path
from ._lens import LensRig

if TYPE_CHECKING:
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming
    from ._view import View

_RIDGE_MARGIN = 40.0  # m that the line of sight clears ridges by at most
_STILL = 0.005  # m, motion of the head from sample to sample of its path, below which it has no new course


@dataclass(frozen=True)
class Chase(LensRig):
    """Perspective camera that follows the head of the fire."""

    distance: float = key(1500.0, "horizontal distance from the head", **LENGTH)
    side: float = key(
        180.0, "bearing from the head, relative to its course; 180: behind, 90: right, 0: in front", **ANGLE
    )
    height: float = key(400.0, "approximate height above the terrain", **HEIGHT)
    target_height: float = key(100.0, "target height above the terrain", **AIM)
    clearance: float = key(50.0, "minimum height above the terrain", **CLEARANCE)
    over_ridges: bool = key(True, "rise until no ridge hides the head")

    @classmethod
    def from_view(cls, view: View) -> Chase:
        """Keep the distance and height above ground that the eye has from the centre of the view."""
        return cls(**view.lens, distance=max(view.away, 1.0), height=view.above)

    def follows_fire(self) -> bool:
        """Return whether its path depends on where the fire will be."""
        return True

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Path at an offset from the head, which is smoothed over a fifth of the filming, looking at it."""
        times = filming.frames.times
        target = targets.follow("head", ground, targets.samples(times), self.target_height)
        away = targets.smoothed(flight.heading(target, _STILL)) + np.radians(self.side)
        position = target + self.distance * np.stack([np.sin(away), np.cos(away), 0.0 * away], axis=-1)
        position[:, 2] = targets.smoothed(ground.up(position[:, 0], position[:, 1])) + self.height
        short = flight.short(ground, position, np.full(len(away), self.clearance))
        margin = min(_RIDGE_MARGIN, 0.5 * self.target_height)  # a low aim would raise it over flat ground
        hidden = path.hidden(ground, position, target, margin)
        position[:, 2] += path.eased(np.maximum(short, hidden) if self.over_ridges else short)
        position, target = (targets.at_frames(each, times) for each in (position, target))
        return Path(
            camera,
            position,
            path.look(position, target),
            target,
            self.half(camera, filming),
            hidden=targets.at_frames(hidden[:, None], times)[:, 0],
            sensor=self.sensor_width,
        )


RIG = Chase
