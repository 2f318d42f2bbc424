"""Camera tracks of an export: place, rotation and lens of each camera in its frames."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import enu_axes
from ..shot.cameras.path import Path
from .request import ExportRequest

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Track:
    """Track of a camera.

    Attributes
    ----------
    name
        Name of the camera.
    frames
        Exported frames (n,) that the camera films, from 1.
    times
        UTC times of the frames.
    position
        (n, 3) scene positions, m.
    rotation
        (n, 3, 3) rotation matrices; their columns are the camera's right, up and back in the scene.
    geodetic
        (n, 3) latitude, longitude (degrees) and height above the ellipsoid, m.
    half
        (n, 2) tangents of half the horizontal and vertical angles of view; half the width and height, m, of
        orthographic pictures; half the angles, radians, of panoramas.
    sensor
        Sensor width, mm.
    projection
        "perspective", "orthographic" or "panorama".
    """

    name: str
    frames: NDArray[np.int64]
    times: tuple[datetime, ...]
    position: Array
    rotation: Array
    geodetic: Array
    half: Array
    sensor: float
    projection: str

    @property
    def focal(self) -> Array:
        """Focal lengths (n,) of a perspective camera, mm."""
        return 0.5 * self.sensor / self.half[:, 0]

    def angles(self, ecef_axes: Array) -> tuple[Array, Array, Array]:
        """Compute heading, tilt and roll (n,) at the camera's own east, north and up, degrees.

        Heading is clockwise from north, tilt is 0 for a view straight down and 90 for a level one, and roll
        is positive if the right side of the picture is lower. These are the angles of a KML `Camera`.

        Parameters
        ----------
        ecef_axes
            (3, 3) Earth-centred directions of the scene's x, y and z as columns.
        """
        latitude, longitude = np.radians(self.geodetic[:, :2]).T
        axes = enu_axes(latitude, longitude) @ ecef_axes @ self.rotation
        right, up, back = np.moveaxis(axes, 2, 0)
        sine = np.hypot(back[:, 0], back[:, 1])
        level = sine > _STRAIGHT
        heading = np.where(level, np.arctan2(-back[:, 0], -back[:, 1]), np.arctan2(up[:, 0], up[:, 1]))
        roll = np.where(level, np.arctan2(-right[:, 2], up[:, 2]), 0.0)
        tilt = np.arctan2(sine, back[:, 2])
        return np.degrees(heading) % 360.0, np.degrees(tilt), np.degrees(roll)


_STRAIGHT = (
    1.0e-6  # sine of the angle to the vertical, below which heading is the direction of the picture's top
)


def find(request: ExportRequest) -> list[Track]:
    """Find the tracks of cameras that film an exported frame, in the order of the scene."""
    found = [_track(request, path) for path in request.shot.paths]
    return [track for track in found if len(track.frames)]


def _track(request: ExportRequest, path: Path) -> Track:
    shot = request.shot
    frames = np.array(sorted({*shot.frames_of(path.camera)} & {*request.frames}), np.int64)
    at = frames - 1
    position = path.position[at]
    kind = "panorama" if path.around else "perspective" if path.perspective else "orthographic"
    return Track(
        name=path.camera.name,
        frames=frames,
        times=tuple(shot.utc(int(frame)) for frame in frames),
        position=position,
        rotation=path.rotation[at],
        geodetic=request.georeference.geodetic(position),
        half=path.halves[at],
        sensor=path.sensor,
        projection=kind,
    )
