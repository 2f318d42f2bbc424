"""Keyframes of properties from arrays."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import compat


def add_keyframes(obj: bpy.types.ID, data_path: str, frames: NDArray[np.float64], values: NDArray) -> None:
    """Keyframe a property (or set it, for a single keyframe): values (n,) or (n, channels)."""
    columns = values.reshape(len(frames), -1)
    owner, _, name = data_path.rpartition(".")
    target = obj.path_resolve(owner) if owner else obj
    setattr(target, name, columns[0] if values.ndim > 1 else float(columns[0, 0]))
    animated = any(curve.data_path == data_path for curve in compat.fcurves(obj))
    if len(frames) == 1 and not animated:
        return
    for index in range(columns.shape[1]):
        curve = compat.new_fcurve(obj, data_path, index)
        curve.keyframe_points.add(len(frames))
        for point, frame, value in zip(curve.keyframe_points, frames, columns[:, index], strict=True):
            point.co = (frame, value)
            point.interpolation = "LINEAR"
        curve.update()
