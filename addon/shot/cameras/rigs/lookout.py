"""Lookout camera: camera on a mast that pans, tilts and zooms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...schema import Where, key
from ...schema.bounds import ANGLE, HEIGHT
from .. import path
from ..path import Path
from ._key import rising
from ._lens import LensRig

if TYPE_CHECKING:
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place
    from ._view import View

_FAR = 5000.0  # m, distance of its look-at points


@dataclass(frozen=True)
class LookoutKey:
    """View of a lookout at one time."""

    at: float = key(0.0, "time of the key; 0: first frame, 1: last frame", at_least=0, at_most=1)
    pan: float = key(0.0, "bearing, clockwise from north; the camera turns the shorter way", **ANGLE)
    tilt: float = key(
        0.0, "angle below the horizon; negative is up", unit="degrees", at_least=-89, at_most=89
    )
    zoom: float = key(1.0, "zoom factor of the focal length", at_least=0.01, at_most=1000)


@dataclass(frozen=True)
class Lookout(LensRig):
    """Camera on a fixed mast that pans, tilts and zooms from key to key."""

    latitude: float = key(0.0, "mast latitude", unit="degrees north", at_least=-90, at_most=90)
    longitude: float = key(
        0.0, "mast longitude; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    height: float = key(20.0, "mast height above the terrain", **HEIGHT)
    keys: tuple[LookoutKey, ...] = key((), "view at one time; without keys the camera looks north")

    @classmethod
    def from_view(cls, view: View) -> Lookout:
        """Mast of the eye's height."""
        keys = (LookoutKey(0.0, view.heading, float(np.clip(view.tilt, -89.0, 89.0))),)
        return cls(
            **view.lens, latitude=view.latitude, longitude=view.longitude, height=view.above, keys=keys
        )

    def validate(self) -> tuple[Where, str] | None:
        """Check that times of keys ascend."""
        return rising(self.keys)

    def coordinates(self) -> list[Place]:
        """Position of the mast."""
        return [(("latitude",), self.latitude, self.longitude)]

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Stay at a fixed position; bearings count from north and tilts from the horizon at the mast."""
        count = filming.frames.count
        keys = self.keys or (LookoutKey(),)
        at, pan, tilt, zoom = np.array([[k.at, k.pan, k.tilt, k.zoom] for k in keys], np.float64).T
        moments = np.linspace(0.0, 1.0, count)
        pan = path.smooth(at, np.unwrap(np.radians(pan)), moments)
        tilt = np.radians(path.smooth(at, tilt, moments))
        zoom = np.exp(path.smooth(at, np.log(zoom), moments))
        place = ground.point(self.latitude, self.longitude, self.height)
        east, north, up = path.compass(ground.frame, place[0])
        flat = np.sin(pan)[:, None] * east + np.cos(pan)[:, None] * north
        position = np.repeat(place, count, axis=0)
        target = position + _FAR * (np.cos(tilt)[:, None] * flat - np.sin(tilt)[:, None] * up)
        across, high = self.half(camera, filming)
        return Path(
            camera,
            position,
            path.look(position, target, up),
            target,
            (across / float(zoom.max()), high / float(zoom.max())),
            wider=zoom.max() / zoom,
            sensor=self.sensor_width,
        )


RIG = Lookout
