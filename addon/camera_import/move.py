"""Camera moves: place, rotation and lens of a camera over time, and their reduction to poses."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from firetwin_core import geo
from numpy.typing import NDArray

from ..geometry.quaternion import matrices, quaternions
from ..shot.cameras import sparse_keys
from ..shot.cameras.rigs import poses

Array = NDArray[np.float64]

_PLACE = 1.0e-3  # m, tolerance of the reduction to keys
_ANGLE = np.radians(1.0e-3)  # rad
_LENS = 1.0e-4  # relative
_SENSORS = (1.0, 200.0)  # mm, plausible sensor widths
_SENSOR = 36.0  # mm, of files with another one
_LENSES = (1.0, 5000.0)  # mm


@dataclass(frozen=True)
class Move:
    """Move of a camera.

    Attributes
    ----------
    name
        Name in the file.
    times
        (n,) ascending times; the unit is `rate` per second.
    position
        (n, 3) scene positions, m.
    rotation
        (n, 3, 3) rotation matrices; their columns are the camera's right, up and back in the scene.
    half
        (n,) tangents of half the horizontal angle of view.
    sensor
        Sensor width, mm.
    rate
        Unit of `times` per second: frames per second, or 1 for seconds.
    """

    name: str
    times: Array
    position: Array
    rotation: Array
    half: Array
    sensor: float = _SENSOR
    rate: float = 1.0


def film_frames(move: Move, times: str, rate: float, count: int) -> Array:
    """Convert the times of a move to frames (n,) of a film, from 1.

    Parameters
    ----------
    times
        "own": numbers of frames (times in frames per second), or from frame 1 (in seconds). "start": from
        frame 1. "shot": from frame 1 to the last frame.
    rate, count
        Frames per second and number of frames of the film.
    """
    since = move.times - move.times[0]
    if times == "shot":
        return 1.0 + since * ((count - 1) / max(since[-1], 1.0e-9))
    if times == "own" and move.rate != 1.0:
        return move.times * (rate / move.rate)
    return 1.0 + since * (rate / move.rate)


def fit(move: Move, frames: Array, count: int, frame: geo.LocalFrame) -> poses.Poses:
    """Fit a rig of few poses to a move at `frames` (n,) of a film with `count` frames.

    Before and after the move the camera rests. Errors in a frame are below 1 mm, 0.001 degrees and 0.01 % of
    the focal length.
    """
    low, high = _SENSORS
    sensor = move.sensor if low <= move.sensor <= high else _SENSOR
    lens = 0.5 * sensor / move.half
    values = np.hstack(
        [
            move.position / _PLACE,
            quaternions(move.rotation) / (0.5 * _ANGLE),  # half-angles
            np.log(lens)[:, None] / _LENS,
        ]
    )
    values = sparse_keys.through(frames, values, np.arange(1.0, count + 1.0))
    place, lens = values[:, :3] * _PLACE, np.exp(values[:, 7] * _LENS)
    rotation = matrices(values[:, 3:7])
    still = np.ptp(values, axis=0).max() < 1.0
    kept = np.zeros(1, np.int64) if still else sparse_keys.fit(values, 1.0)
    lens = np.round(np.clip(lens[kept], *_LENSES), 6)
    keys = poses.keyed(frame, kept / max(count - 1, 1), place[kept], rotation[kept], lens)
    return poses.Poses(float(lens[0]), round(sensor, 6), tuple(map(_rounded, keys)))


def _rounded(key: poses.PoseKey) -> poses.PoseKey:
    """Round a key to 0.1 mm and 1e-6 degrees."""
    return replace(
        key,
        latitude=round(key.latitude, 9),
        longitude=round(key.longitude, 9),
        height=round(key.height, 4),
        heading=round(key.heading, 6) % 360.0,
        tilt=round(key.tilt, 6),
        roll=round(key.roll, 6),
    )
