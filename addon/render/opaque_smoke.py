"""Distance of opaque smoke in the cells of a picture: surfaces behind it are not seen, and need no light."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from firetwin_core import volume
from numpy.typing import NDArray

from ..geometry.grids import dilate
from ..smoke import shutter
from . import flame_distance, rays, smoke_range

_CELL = 8  # pixels along a cell
_AROUND = 2  # cells: the farthest smoke of those around counts
DEPTH = 12.0
"""Optical depth of opaque smoke, which transmits 6e-6 of the light; a march ends at a thousandth."""


def measure(
    smoke: Sequence[volume.Bricks], camera: bpy.types.Object, scene: bpy.types.Scene, extinction: float
) -> NDArray[np.float32] | None:
    """Measure the distance (h, w) of opaque smoke in the cells of `flame_distance`, m; None if it is clear.

    Parameters
    ----------
    extinction
        Factor on the extinction of the smoke.
    """
    if extinction <= 0.0:
        return None
    lines = rays.cell_rays(camera, scene, _CELL)
    flat, depth = lines.directions.reshape(-1, 3), DEPTH / extinction
    away = [
        volume.opaque_distance(moment, lines.origins, flat, smoke_range.STEP, depth)
        for _, moment in shutter.moments(smoke)
    ]
    far = np.max(away, axis=0).reshape(lines.directions.shape[:2])
    finer = _CELL // flame_distance.CELL
    wide = dilate(far, _AROUND).repeat(finer, axis=0).repeat(finer, axis=1)
    height, width = rays.cells(scene, flame_distance.CELL)
    return np.asarray(wide[:height, :width], np.float32)
