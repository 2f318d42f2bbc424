"""A drone: a camera in perspective that flies from key to key."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .. import flight, path, targets
from ..flight import Waypoints
from ..path import Array, Path
from ..schema import Where, key
from ._key import CameraKey, rising
from ._lens import Lens

if TYPE_CHECKING:
    from ..ground import Ground
    from ..settings import Camera
    from ..shot import Shot
    from . import Place

_CLEARANCE = 0.35  # of the height asked for above the ground that stays over hills between keys


@dataclass(frozen=True)
class Drone(Lens):
    """In perspective, flying smoothly from key to key."""

    over_ridges: bool = key(
        False, 'rise until it sees its "head" or "fire" over the ridges; else it keeps its height'
    )
    clearance: float = key(
        10.0, "never nearer to the ground than this, also between frames", unit="m", above=0
    )
    bank: float = key(
        0.0, "how much it leans into turns; 1: as an aircraft, 0: the horizon is level", at_least=0, at_most=1
    )
    vibration: float = key(
        0.0,
        "standard deviation about each axis; 0.02 is a good gimbal's",
        unit="degrees",
        at_least=0,
        at_most=5,
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
        """Smooth between keys, over the hills between them, looking at its targets."""
        count = shot.frames.count
        moments = np.linspace(0.0, 1.0, count) if count > 1 else np.zeros(1)
        keys = sorted(self.keys, key=lambda each: each.at)
        way = _waypoints(keys)
        position = way.flown(ground, moments)
        over = path.smooth(way.at, np.where(way.over_ground, way.height, 0.0), moments)
        target = self._target(keys, position, moments, shot, ground)
        short = flight.short(ground, position, np.maximum(self.clearance, _CLEARANCE * over))
        hidden = np.zeros(count)
        if any(each.target in targets.MOVING for each in keys):  # nobody could know where the fire would be
            hidden = path.hidden(ground, position, target)
        if self.over_ridges:
            short = np.maximum(short, hidden)
        position[:, 2] += path.eased(short)
        target = self._target(keys, position, moments, shot, ground)
        rotation = path.look(position, target)
        if self.bank > 0.0:
            rotation = flight.rolled(rotation, self.bank * flight.bank(position, shot.frames.step))
        if self.vibration > 0.0:
            rotation = flight.trembling(rotation, self.vibration, shot.settings.seed, camera.name)
        half = self.half(camera, shot)
        return Path(camera, position, rotation, target, half, hidden=hidden, sensor=self.sensor_width)

    def _target(
        self, keys: list[CameraKey], position: Array, moments: Array, shot: Shot, ground: Ground
    ) -> Array:
        """Where it looks (frames, 3) from there."""
        at = np.array([each.at for each in keys])
        return path.blend(at, np.array([_aim(each, position, shot, ground) for each in keys]), moments)


def _waypoints(keys: list[CameraKey]) -> Waypoints:
    columns = ("at", "latitude", "longitude", "height")
    values = (np.array([getattr(each, name) for each in keys], np.float64) for name in columns)
    return Waypoints(*values, np.array([each.above == "ground" for each in keys]))


def _aim(at: CameraKey, position: Array, shot: Shot, ground: Ground) -> Array:
    """Where a key points in every frame (frames, 3)."""
    if at.target == "ahead":
        return flight.ahead(position, np.full(len(position), at.tilt))
    if at.target == "point":
        place = ground.point(at.target_latitude, at.target_longitude, at.target_height)
        return np.repeat(place, shot.frames.count, axis=0)
    return targets.follow(at.target, ground, shot.frames.times, at.target_height)


RIG = Drone
