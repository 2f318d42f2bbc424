"""A camera for headsets: all round and in stereo, from a place or along a way."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from .. import path
from ..bounds import CLEARANCE
from ..path import Path
from ..schema import Where, key
from ..track import MOMENTS
from . import Rig
from ._key import CameraKey
from .drone import Drone

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from ..frames import Frames
    from ..ground import Ground
    from ..settings import Camera
    from ..shot import Shot
    from . import Place


@dataclass(frozen=True)
class Vr(Rig):
    """All round in stereo for headsets, the left eye's picture above the right one's.

    Each eye's picture is equirectangular, so that of both is square. The horizon is level whatever the keys'
    targets: these say only what is in the middle of the picture. Towards straight up and down the eyes come
    together, or the poles would be seen double.
    """

    around: ClassVar[bool] = True
    interocular: float = key(
        0.065, "between the eyes; 0.065 is life-size, 6.5 a model of 1:100", unit="m", at_least=0, at_most=100
    )
    clearance: float = key(10.0, "never nearer to the ground than this, also between frames", **CLEARANCE)
    track: File | None = key(  # noqa: RUF009
        None, "flight to follow, as a drone does", shows=()
    )
    track_times: str = key("own", "when a track with times is flown", choices=MOMENTS)
    keys: tuple[CameraKey, ...] = key((), "where it is at one moment")

    def wrong(self) -> tuple[Where, str] | None:
        """It is somewhere, and its moments rise."""
        if not self.keys and self.track is None:
            return ("keys",), "has no [[cameras.keys]] and no track; one key puts it in a place"
        return self._drone().wrong()

    def places(self) -> list[Place]:
        """Its keys, and the points in the middle of its pictures."""
        return self._drone().places()

    def reads(self) -> list[File]:
        """Its track."""
        return self._drone().reads()

    def misfit(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """A track that keeps its own times is flown while the frames are."""
        return self._drone().misfit(run, frames)

    def path(self, camera: Camera, shot: Shot, ground: Ground) -> Path:
        """Where a drone with these keys would be, upright; what it sees next to its feet is to the north."""
        flown = self._drone().path(camera, shot, ground)
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
        """The drone whose way is its own."""
        return Drone(clearance=self.clearance, track=self.track, track_times=self.track_times, keys=self.keys)


RIG = Vr
