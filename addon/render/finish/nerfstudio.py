"""Convert depth and classes to the depth and mask files that nerfstudio reads."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor

from ...shot.passes.masks import FIRE, SKY, SMOKE
from ...shot.shot import Shot
from . import Files

MILLIMETRES = 1000.0  # per metre; the inverse of nerfstudio's default depth_unit_scale_factor
_SKY = 1.0e9  # m; depth of the sky is 1e10


def finish(files: Files, needed: Mapping[str, Files], _shot: Shot, _camera: str, _frame: int) -> None:
    """Write planar depth (mm, sky 0), and a mask that is 255 on static surfaces."""
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0].astype(np.float64)
    np.save(files["npy"], np.where(planar < _SKY, planar * MILLIMETRES, 0.0).astype(np.float32))
    kind = sensor.read_image(needed["masks"]["exr"])[..., 0]
    static = ~np.isin(kind, (SKY, SMOKE, FIRE))
    sensor.write_image(files["png"], static.astype(np.float32))
