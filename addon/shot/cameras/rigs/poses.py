"""Posed camera: keyframes of position, rotation and lens, as flown or keyed by hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ....geometry.quaternion import matrices, quaternions
from ...schema import Where, key
from ...schema.bounds import AIM, ANGLE
from .. import path, sparse_keys
from .. import rotation as turning
from ..path import Path
from ._key import rising
from ._lens import FOCAL_LENGTH, LensRig

if TYPE_CHECKING:
    from firetwin_core import geo

    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place
    from ._view import View

_FAR = 5000.0  # m, distance of its look-at points


@dataclass(frozen=True)
class PoseKey:
    """Position and orientation of a camera at one time, independent of the terrain."""

    at: float = key(0.0, "time of the key; 0: first frame, 1: last frame", at_least=0, at_most=1)
    latitude: float = key(0.0, "camera latitude", unit="degrees north", at_least=-90, at_most=90)
    longitude: float = key(
        0.0, "camera longitude; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    height: float = key(2000.0, "camera height above sea level", **AIM)
    heading: float = key(0.0, "heading, clockwise from north", **ANGLE)
    tilt: float = key(
        0.0, "angle below the horizon; negative is up", unit="degrees", at_least=-90, at_most=90
    )
    roll: float = key(0.0, "roll to the right", **ANGLE)
    lens: float | None = key(None, "focal length; default: the lens of the camera", **FOCAL_LENGTH)


@dataclass(frozen=True)
class Poses(LensRig):
    """Perspective camera that moves through poses flown or keyed by hand."""

    keys: tuple[PoseKey, ...] = key((), "pose at one time")

    @classmethod
    def from_view(cls, view: View) -> Poses:
        """Pose of the view."""
        pose = PoseKey(0.0, view.latitude, view.longitude, view.height, view.heading, view.tilt, view.roll)
        return cls(**view.lens, keys=(pose,))

    def validate(self) -> tuple[Where, str] | None:
        """Check that there are keys, and that their times ascend."""
        if not self.keys:
            return ("keys",), "has no [[cameras.keys]]; poses need at least one"
        return rising(self.keys)

    def coordinates(self) -> list[Place]:
        """Positions of its poses."""
        return [(("keys", i, "latitude"), at.latitude, at.longitude) for i, at in enumerate(self.keys)]

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Cubic interpolation of positions, quaternions and logarithms of focal lengths between poses."""
        keys, frame = self.keys, ground.frame
        columns = ((pose.latitude, pose.longitude, pose.height) for pose in keys)
        place = frame.forward(*np.array([*columns], np.float64).T.copy())
        matrix = np.array([_matrix(frame, at, pose) for at, pose in zip(place, keys, strict=True)])
        lens = np.log([[pose.lens or self.focal_length] for pose in keys])
        at = np.array([pose.at for pose in keys], np.float64)
        values = np.hstack([place, quaternions(matrix), lens])
        moments = np.linspace(0.0, 1.0, filming.frames.count)
        shown = sparse_keys.through(at, values, moments)
        exact = {round(moment, 12): k for k, moment in enumerate(at)}
        for i, moment in enumerate(moments):  # exact values in the frames of keys
            if (k := exact.get(round(float(moment), 12))) is not None:
                shown[i] = values[k]
        rotation, wider = matrices(shown[:, 3:7]), np.exp(-shown[:, 7])
        across, high = self.half(camera, filming)
        longest = float(wider.min()) * self.focal_length
        return Path(
            camera,
            shown[:, :3],
            rotation,
            shown[:, :3] - _FAR * rotation[:, :, 2],
            (across * longest, high * longest),
            wider=wider / wider.min(),
            sensor=self.sensor_width,
        )


def _matrix(frame: geo.LocalFrame, place: path.Array, pose: PoseKey) -> path.Array:
    return turning.turned(frame, place, pose.heading, pose.tilt, pose.roll)


def keyed(
    frame: geo.LocalFrame, at: path.Array, place: path.Array, rotation: path.Array, lens: path.Array
) -> tuple[PoseKey, ...]:
    """Poses of a camera at times (k,): positions (k, 3), matrices (k, 3, 3) in the scene, lenses (k,), mm.

    Parameters
    ----------
    lens
        If all are equal, the camera's focal length replaces the lenses of the poses.
    """
    latitude, longitude, height = frame.reverse(place)
    several = bool(np.ptp(lens) > 0.0)
    return tuple(
        PoseKey(
            float(at[k]),
            float(latitude[k]),
            float(longitude[k]),
            float(height[k]),
            *turning.angles(frame, place[k], rotation[k]),
            float(lens[k]) if several else None,
        )
        for k in range(len(at))
    )


RIG = Poses
