"""Camera poses in the conventions of other programs, from our camera-to-world matrices.

Ours: x right, y up, z backwards (OpenGL, Blender, nerfstudio); the first pixel has its centre at (0.5, 0.5),
as in COLMAP and nerfstudio. OpenCV: x right, y down, z forwards.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..geometry.quaternion import quaternions

Matrix = NDArray[np.float64]
_TO_OPENCV = np.diag([1.0, -1.0, -1.0, 1.0])


def world_to_opencv(to_world: Matrix) -> Matrix:
    """Compute the world-to-camera matrix (4, 4) with OpenCV's camera axes of our camera-to-world matrix."""
    inverse = np.eye(4)
    pose = np.asarray(to_world, np.float64) @ _TO_OPENCV
    inverse[:3, :3] = pose[:3, :3].T
    inverse[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return inverse


def quaternion(pose: Matrix) -> Matrix:
    """Compute the unit quaternion (4,) w, x, y, z, w >= 0, of the rotation of a pose (4, 4)."""
    value = quaternions(np.asarray(pose, np.float64)[None, :3, :3])[0]
    return -value if value[0] < 0.0 else value
