"""VR camera: stereo panorama for headsets, from a fixed point or along a path."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ...schema import Where, key
from ...schema.bounds import CLEARANCE
from .. import path
from ..path import Path
from ..track import MOMENTS
from . import Rig
from ._key import CameraKey
from .drone import Drone

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from ...frames import Frames
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place


@dataclass(frozen=True)
class Vr(Rig):
    """Stereo panorama for headsets, the left eye's picture above the right eye's.

    Each eye's picture is equirectangular, so the picture of both eyes is square. The horizon is level.
    Targets of keys set only the centre of the picture. The distance between the eyes decreases to 0 towards
    the zenith and nadir; otherwise the poles would be seen double.
    """

    around: ClassVar[bool] = True
    interocular: float = key(
        0.065,
        "distance between the eyes; 0.065: life size, 6.5: a model of 1:100",
        unit="m",
        at_least=0,
        at_most=100,
    )
    clearance: float = key(10.0, "minimum height above the terrain, also between frames", **CLEARANCE)
    track: File | None = key(  # noqa: RUF009
        None, "flight track, as of a drone", affects=()
    )
    track_times: str = key("own", "time base of a track with times", choices=MOMENTS)
    keys: tuple[CameraKey, ...] = key((), "position and view at one time")

    def validate(self) -> tuple[Where, str] | None:
        """Check that there are keys or a track, and that times of keys ascend."""
        if not self.keys and self.track is None:
            return ("keys",), "has no [[cameras.keys]] and no track; one key puts it in a place"
        return self._drone().validate()

    def coordinates(self) -> list[Place]:
        """Positions of its keys, and the targets at the centre of its pictures."""
        return self._drone().coordinates()

    def input_files(self) -> list[File]:
        """Its track."""
        return self._drone().input_files()

    def validate_against(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """Check that a track with recorded times overlaps the shot."""
        return self._drone().validate_against(run, frames)

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Path of a drone with these keys, with a level horizon; a target below its feet counts as north."""
        flown = self._drone().path(camera, filming, ground)
        latitude, longitude, height = ground.frame.reverse(flown.position)
        low, high = (ground.frame.forward(latitude, longitude, height + d) for d in (-1000.0, 1000.0))
        up = (high - low) / np.linalg.norm(high - low, axis=1, keepdims=True)
        ahead = flown.target - flown.position
        flat = ahead - np.sum(ahead * up, axis=1, keepdims=True) * up
        below = np.linalg.norm(flat, axis=1, keepdims=True) < 1.0  # m
        north = np.array([0.0, 1.0, 0.0]) - up[:, 1:2] * up
        flat = np.where(below, north, flat)
        rotation = path.look(flown.position, flown.position + flat, up)
        half = (np.pi, 0.5 * np.pi)
        return Path(camera, flown.position, rotation, flown.target, half, around=True, apart=self.interocular)

    def _drone(self) -> Drone:
        """Make the drone whose path it takes."""
        return Drone(clearance=self.clearance, track=self.track, track_times=self.track_times, keys=self.keys)


RIG = Vr
