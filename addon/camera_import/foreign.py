"""Cameras of foreign scenes, as a job in Blender returns them.

The axes of a scene are right-handed with z up, in metres. Cameras look along -z, with y up.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import input_error, reading
from ..jobs import worker
from ..limits import CAMERA_MEMORY, CAMERA_SECONDS
from ..progress import MessageCallback, Progress
from .move import Move
from .placing import Origin

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ForeignScene:
    """Cameras of a file.

    Attributes
    ----------
    rate
        Frames per second.
    origin
        Latitude, longitude (degrees) and height above the ellipsoid (m) of its origin; None: not in the file.
    cameras
        For each perspective camera `name`, `frames` (n,), `matrix` (n, 4, 4, for columns), `half` (n,)
        (tangent of half the horizontal angle of view) and `sensor` (mm).
    omitted
        Names of other cameras.
    """

    rate: float
    origin: Origin | None
    cameras: list[dict[str, Any]]
    omitted: list[str]

    def moves(self, path: Path, matrix: Array) -> list[Move]:
        """Return the moves in a scene; `matrix` (4, 4) transforms to its metres."""
        return [_move(path, camera, self.rate, matrix) for camera in self.cameras]


def read(path: Path, work: worker.Work[ForeignScene], progress: Progress) -> ForeignScene:
    """Read a file in a separate process, with limits, which a damaged file may crash.

    Raises
    ------
    InputError, Error
        The file cannot be read.
    """
    try:
        guarded = partial(_guarded, path, work)
        return worker.run(guarded, progress, patience=CAMERA_SECONDS, size=CAMERA_MEMORY)
    except worker.EndedError:
        most = f"more than {CAMERA_MEMORY / 1e9:.1f} GB of memory or {CAMERA_SECONDS} s to read"
        raise input_error(path, f"is damaged, or needs {most}; export only its cameras") from None


def _guarded(
    path: Path, work: worker.Work[ForeignScene], progress: Progress, tell: MessageCallback
) -> ForeignScene:
    """Read a file, and name it in errors; worker side."""
    with reading(path):
        return work(progress=progress, tell=tell)


def _move(path: Path, camera: dict[str, Any], rate: float, matrix: Array) -> Move:
    poses: Array = matrix @ np.array(camera["matrix"], np.float64).reshape(-1, 4, 4)
    half = np.array(camera["half"], np.float64)
    rotation = poses[:, :3, :3]
    right, up = rotation[:, :, 0], rotation[:, :, 1]
    if not (np.isfinite(poses).all() and np.isfinite(half).all() and (half > 0.0).all()):
        raise input_error(path, f'camera "{camera["name"]}" has a position or a lens that is not a number')
    with np.errstate(divide="ignore", invalid="ignore"):  # a scale of 0 is reported below
        right = right / np.linalg.norm(right, axis=1, keepdims=True)
        up = up - np.sum(up * right, axis=1, keepdims=True) * right
        up = up / np.linalg.norm(up, axis=1, keepdims=True)
    rotation = np.stack([right, up, np.cross(right, up)], axis=-1)
    if not np.isfinite(rotation).all() or (np.sum(rotation[:, :, 2] * poses[:, :3, 2], axis=1) <= 0.0).any():
        raise input_error(path, f'camera "{camera["name"]}" is mirrored or has a scale of 0; unscale it')
    frames = np.array(camera["frames"], np.float64)
    return Move(camera["name"], frames, poses[:, :3, 3], rotation, half, camera["sensor"], rate)
