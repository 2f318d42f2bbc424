"""Satellite camera: nadir view from far above, or view from a geostationary orbit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ....run.frame import local_frame
from ...schema import Where, key
from ...schema.bounds import SWATH
from .. import path
from ..path import Array, Path
from . import Rig
from ._key import CameraKey, rising

if TYPE_CHECKING:
    from firetwin_core import geo
    from firetwin_core.run import Run

    from ...frames import Frames
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place
    from ._view import View

HEIGHT = 60_000.0  # m above ground, above all smoke
ORBIT = 35_786_023.0  # m above the equator: 42,164.160 km from the Earth's centre, less 6,378.137 km
_LOWEST = 5.0  # degrees, lowest elevation of the satellite; below, air and hills obstruct the view


@dataclass(frozen=True)
class Satellite(Rig):
    """Orthographic nadir view, or a perspective view from a geostationary orbit.

    It views the latitude and longitude of its first key; without keys, the middle of the run.
    """

    swath: float = key(56_000.0, "swath: ground width of the picture", **SWATH)
    geostationary: float | None = key(
        None,
        "longitude of a geostationary orbit, 35,786 km high; default: nadir view",
        unit="degrees east",
        at_least=-180,
        at_most=180,
    )
    keys: tuple[CameraKey, ...] = key(
        (), "the first key is the point viewed; without keys, the middle of the run"
    )

    @classmethod
    def from_view(cls, view: View) -> Satellite:
        """Nadir view of the centre of the view, with the same width."""
        return cls(swath=view.width, keys=(CameraKey(0.0, *view.aim),))

    def validate(self) -> tuple[Where, str] | None:
        """Check that times of keys ascend."""
        return rising(self.keys)

    def coordinates(self) -> list[Place]:
        """Look at the point viewed."""
        return [(("keys", i, "latitude"), at.latitude, at.longitude) for i, at in enumerate(self.keys)]

    def validate_against(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """Check that a geostationary satellite is above the fire's horizon."""
        if self.geostationary is None:
            return None
        frame = local_frame(run)
        first = self.keys[0] if self.keys else frame
        place = frame.forward([first.latitude], [first.longitude], [0.0])[0]
        over = _over_horizon(place, _eye(frame, self.geostationary), frame)
        if over >= _LOWEST:
            return None
        where = f"{over:.0f} degrees over the horizon of" if over > 0.0 else "under the horizon of"
        reason = (
            f"is {where} the fire from {self.geostationary:g} E; -137 is one that sees the west of America"
        )
        return ("geostationary",), reason

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Stay at a fixed position."""
        first = self.keys[0] if self.keys else ground.frame
        place = np.repeat(ground.point(first.latitude, first.longitude), filming.frames.count, axis=0)
        if self.geostationary is None:
            return down(camera, filming, place, self.swath)
        position = np.repeat(_eye(ground.frame, self.geostationary)[None], len(place), axis=0)
        tilt = np.radians(ground.frame.latitude)
        axis = np.array([0.0, np.cos(tilt), np.sin(tilt)])  # the Earth's: rows of its pictures are parallels
        rotation = path.look(position, place, axis)
        distance = float(np.linalg.norm(position[0] - place[0]))
        return Path(
            camera, position, rotation, place, half(camera, filming, self.swath), False, meet=distance
        )


def _eye(frame: geo.LocalFrame, longitude: float) -> Array:
    """Its position (3,) in the scene in single precision (to 2 or 4 m), as Blender stores it."""
    return frame.forward([0.0], [longitude], [ORBIT])[0].astype(np.float32).astype(np.float64)


def _over_horizon(place: Array, eye: Array, frame: geo.LocalFrame) -> float:
    """Elevation (degrees) of an eye above the horizon of a point, both (3,) in the scene."""
    way = (eye - place) / np.linalg.norm(eye - place)
    return float(np.degrees(np.arcsin(way @ path.compass(frame, place)[2])))


def down(camera: CameraSettings, filming: Filming, place: Array, swath: float) -> Path:
    """Path above ground points (frames, 3), looking straight down with north up."""
    position = place + np.array([0.0, 0.0, HEIGHT])
    rotation = np.repeat(np.eye(3)[None], len(place), axis=0)
    return Path(camera, position, rotation, place, half(camera, filming, swath), perspective=False)


def half(camera: CameraSettings, filming: Filming, swath: float) -> tuple[float, float]:
    """Half the width and height (m) of a picture of this swath."""
    width, height = filming.resolution(camera)
    return 0.5 * swath, 0.5 * swath * height / width


RIG = Satellite
