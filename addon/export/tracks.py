"""Camera tracks of an export, with UTC times and positions on the Earth."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import enu_axes
from ..geometry.camera_track import CameraTrack
from ..shot.cameras.path import Path, clip
from ..shot.shot import Shot
from .request import ExportRequest

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Track(CameraTrack):
    """Track of a camera on the Earth.

    Attributes
    ----------
    times
        UTC times of the frames.
    geodetic
        (f, 3) latitude, longitude (degrees) and height above the ellipsoid, m.
    """

    times: tuple[datetime, ...]
    geodetic: Array

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
    track = make(shot, replace(path, meet=0.0), frames)  # very distant: counts as orthographic
    times = tuple(shot.utc(int(frame)) for frame in frames)
    return Track(**vars(track), times=times, geodetic=request.georeference.geodetic(track.position))


def make(shot: Shot, path: Path, frames: NDArray[np.int64]) -> CameraTrack:
    """Take these frames of a path."""
    at = frames - 1
    perspective = path.perspective or path.meet > 0.0
    planes = np.tile(clip(path, shot.ground), (len(frames), 1)) if path.clips is None else path.clips[at]
    return CameraTrack(
        name=path.camera.name,
        frames=frames,
        position=path.position[at],
        rotation=path.rotation[at],
        half=path.halves[at] / (path.meet or 1.0),
        sensor=path.sensor,
        projection="panorama" if path.around else "perspective" if perspective else "orthographic",
        clip=planes,
    )
