"""A drone: a camera in perspective that flies from key to key."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import path, targets
from ..path import Array, Path
from ..schema import Where, key
from . import Rig
from ._key import CameraKey, rising

if TYPE_CHECKING:
    from ..ground import Ground
    from ..settings import Camera
    from ..shot import Shot
    from . import Place

_CLEARANCE = 0.35  # of the height asked for that stays over hills between keys


@dataclass(frozen=True)
class Drone(Rig):
    """In perspective, flying smoothly from key to key."""

    focal_length: float = key(28.0, "of the lens; film is 36 mm wide", unit="mm", at_least=1, at_most=5000)
    over_ridges: bool = key(
        False, 'rise until it sees its "head" or "fire" over the ridges between; else it keeps its height'
    )
    keys: tuple[CameraKey, ...] = key((), "where it is at one moment")

    def wrong(self) -> tuple[Where, str] | None:
        """A drone is somewhere, and its moments rise."""
        if not self.keys:
            return ("keys",), "has no [[cameras.keys]]; a drone needs at least one"
        return rising(self.keys)

    def places(self) -> list[Place]:
        """Its keys, and the points that it looks at."""
        found: list[Place] = []
        for i, at in enumerate(self.keys):
            found.append((("keys", i, "latitude"), at.latitude, at.longitude))
            if at.target == "point":
                found.append((("keys", i, "target_latitude"), at.target_latitude, at.target_longitude))
        return found

    def path(self, camera: Camera, shot: Shot, ground: Ground) -> Path:
        """Smooth between keys, over the hills between them, looking at its targets with the horizon level."""
        keys = sorted(self.keys, key=lambda each: each.at)
        at = np.array([each.at for each in keys])
        count = shot.frames.count
        moments = np.linspace(0.0, 1.0, count) if count > 1 else np.zeros(1)
        base = ground.point(*(_column(keys, name) for name in ("latitude", "longitude", "height")))
        position = np.stack([path.smooth(at, base[:, axis], moments) for axis in range(3)], axis=-1)
        aims = [_aim(each, shot, ground) for each in keys]
        target = path.blend(at, np.array(aims), moments)
        short = path.below(ground, position, _CLEARANCE * path.smooth(at, _column(keys, "height"), moments))
        hidden = np.zeros(count)
        if any(each.target != "point" for each in keys):  # nobody could know where the fire would be
            hidden = path.hidden(ground, position, target)
        if self.over_ridges:
            short = np.maximum(short, hidden)
        position[:, 2] += path.eased(short)
        return Path(
            camera,
            position,
            path.look(position, target),
            target,
            path.half_view(shot, self.focal_length),
            hidden=hidden,
        )


def _column(keys: list[CameraKey], name: str) -> Array:
    return np.array([getattr(each, name) for each in keys], np.float64)


def _aim(at: CameraKey, shot: Shot, ground: Ground) -> Array:
    """Where a key points in every frame (frames, 3)."""
    if at.target == "point":
        place = ground.point(at.target_latitude, at.target_longitude, at.target_height)
        return np.repeat(place, shot.frames.count, axis=0)
    return targets.follow(at.target, ground, shot.frames.times, at.target_height)


RIG = Drone
