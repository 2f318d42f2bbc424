"""Drone camera: perspective camera that flies from key to key."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING

import numpy as np

from ...schema import Where, key
from ...schema.bounds import CLEARANCE
from .. import flight, path, targets
from ..flight import Waypoints
from ..path import Array, Path
from ..track import MOMENTS, read
from ._key import CameraKey, rising
from ._lens import LensRig

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from ...frames import Frames
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place
    from ._view import View

_CLEARANCE = 0.35  # minimum height over hills between keys / requested height above ground


@dataclass(frozen=True)
class Drone(LensRig):
    """Perspective camera that flies smoothly from key to key or along a track."""

    over_ridges: bool = key(
        False, 'rise until no ridge hides the target "head" or "fire"; otherwise keep the height'
    )
    clearance: float = key(10.0, "minimum height above the terrain, also between frames", **CLEARANCE)
    bank: float = key(0.0, "bank in turns; 1: as an aircraft, 0: level horizon", at_least=0, at_most=1)
    vibration: float = key(
        0.0,
        "standard deviation of vibration about each axis; 0.02: a good gimbal",
        unit="degrees",
        at_least=0,
        at_most=5,
    )
    track: File | None = key(  # noqa: RUF009
        None,
        "flight track, .gpx, .kml or .csv; keys then set only the view (no keys: ahead)",
        affects=(),
    )
    track_times: str = key("own", "time base of a track with times", choices=MOMENTS)
    keys: tuple[CameraKey, ...] = key((), "position and view at one time")

    @classmethod
    def from_view(cls, view: View) -> Drone:
        """Hover at the eye and look at the centre of the view."""
        place = view.latitude, view.longitude, max(view.height, 1.0)
        return cls(**view.lens, keys=(CameraKey(0.0, *place, "point", *view.aim, above="sea"),))

    def validate(self) -> tuple[Where, str] | None:
        """Check that there are keys or a track, and that times of keys ascend."""
        if not self.keys and self.track is None:
            return ("keys",), "has no [[cameras.keys]] and no track; a drone needs at least one key"
        return rising(self.keys)

    def coordinates(self) -> list[Place]:
        """Positions and targets of its keys."""
        result: list[Place] = []
        for i, at in enumerate(self.keys):
            if self.track is None:
                result.append((("keys", i, "latitude"), at.latitude, at.longitude))
            if at.target == "point":
                result.append((("keys", i, "target_latitude"), at.target_latitude, at.target_longitude))
        if self.track is not None:
            result += [(("track",), *corner) for corner in read(self.track).corners()]
        return result

    def input_files(self) -> list[File]:
        """Its track."""
        return [] if self.track is None else [self.track]

    def validate_against(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """Check that a track with recorded times overlaps the shot."""
        if self.track is None or self.track_times != "own":
            return None
        missed = read(self.track).missed(run, frames)
        return (("track",), f"follows {self.track.name}, which {missed}") if missed else None

    def follows_fire(self) -> bool:
        """Return whether its path depends on where the fire will be."""
        return any(pose.target in targets.MOVING for pose in self.keys)

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Smooth path between keys or along its track, above the hills between, with its look-at points."""
        count = filming.frames.count
        moments = np.linspace(0.0, 1.0, count)
        keys = sorted(self.keys, key=lambda pose: pose.at) or [CameraKey(target="ahead")]
        clearance = np.full(count, self.clearance)
        if self.track is None:
            way = _waypoints(keys)
            position = way.flown(ground, moments)
            over = path.smooth(way.at, np.where(way.over_ground, way.height, 0.0), moments)
            clearance = np.maximum(clearance, _CLEARANCE * over)
        else:
            recorded = read(self.track)
            way, shown = recorded.at(self.track_times, filming.run, filming.frames, ground.frame)
            position = way.flown(ground, shown)
        moving = _moving(keys, filming, ground)
        target = self._target(keys, position, moments, filming, ground, moving)
        short = flight.short(ground, position, clearance)
        hidden = np.zeros(count)
        if any(pose.target in targets.MOVING for pose in keys):  # a pilot cannot foresee the fire's position
            hidden = path.hidden(ground, position, target)
        if self.over_ridges:
            short = np.maximum(short, hidden)
        position[:, 2] += path.eased(short)
        target = self._target(keys, position, moments, filming, ground, moving)
        rotation = path.look(position, target)
        if self.bank > 0.0:
            rotation = flight.rolled(rotation, self.bank * flight.bank(position, filming.frames.step))
        if self.vibration > 0.0:
            rotation = flight.trembling(rotation, self.vibration, filming.seed, camera.name)
        half = self.half(camera, filming)
        return Path(camera, position, rotation, target, half, hidden=hidden, sensor=self.sensor_width)

    def _target(
        self,
        keys: list[CameraKey],
        position: Array,
        moments: Array,
        filming: Filming,
        ground: Terrain,
        moving: dict[tuple[str, float], Array],
    ) -> Array:
        """Look-at points (frames, 3) from these positions."""
        at = np.array([pose.at for pose in keys])
        aims = [_aim(pose, position, filming, ground, moving) for pose in keys]
        return path.blend(at, np.array(aims), moments)


def _waypoints(keys: list[CameraKey]) -> Waypoints:
    values = np.array([(pose.at, pose.latitude, pose.longitude, pose.height) for pose in keys], np.float64)
    at, latitude, longitude, height = values.T
    return Waypoints(at, latitude, longitude, height, np.array([pose.above == "ground" for pose in keys]))


def _moving(keys: list[CameraKey], filming: Filming, ground: Terrain) -> dict[tuple[str, float], Array]:
    """Positions (frames, 3) of moving targets, by name and height above ground."""
    wanted = {(each.target, each.target_height) for each in keys if each.target in targets.MOVING}
    return {each: targets.follow(each[0], ground, filming.frames.times, each[1]) for each in wanted}


def _aim(
    at: CameraKey, position: Array, filming: Filming, ground: Terrain, moving: dict[tuple[str, float], Array]
) -> Array:
    """Look-at points (frames, 3) of a key."""
    if at.target == "ahead":
        return flight.ahead(position, np.full(len(position), at.tilt))
    if at.target == "point":
        place = ground.point(at.target_latitude, at.target_longitude, at.target_height)
        return np.repeat(place, filming.frames.count, axis=0)
    return moving[at.target, at.target_height]


RIG = Drone
