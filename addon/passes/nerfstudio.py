"""Training pass: depth and mask of each frame as nerfstudio reads them.

The NPY file has the planar depth in millimetres, float32 (h, w), with 0 in the sky; nerfstudio multiplies it
by `depth_unit_scale_factor`, 0.001 by default. The PNG has one channel: 255 where a pixel shows terrain,
trees or buildings, and 0 for sky, smoke and fire, which have no fixed surface. nerfstudio trains on non-zero
pixels. The index `transforms.json` names both files as `depth_file_path` and `mask_path`; it needs `rgb` and
`pose`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor

from ..shot.passes import DerivedPass, Files
from ..shot.shot import Shot
from .masks import FIRE, SKY, SMOKE

ORDER = 42
HELP = (
    "Depth (mm, NPY) and mask of static surfaces (PNG) of each frame for nerfstudio, "
    "listed in transforms.json with rgb and pose"
)

PASS = DerivedPass(files=("npy", "png"), single_view=True, needs=("depth", "masks"))

MILLIMETRES = 1000.0  # per metre; the inverse of nerfstudio's default depth_unit_scale_factor
_SKY = 1.0e9  # m; depth of the sky is 1e10


def finish(files: Files, needed: Mapping[str, Files], _shot: Shot, _camera: str, _frame: int) -> None:
    """Write planar depth (mm, sky 0), and a mask that is 255 on static surfaces."""
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0].astype(np.float64)
    np.save(files["npy"], np.where(planar < _SKY, planar * MILLIMETRES, 0.0).astype(np.float32))
    kind = sensor.read_image(needed["masks"]["exr"])[..., 0]
    static = ~np.isin(kind, (SKY, SMOKE, FIRE))
    sensor.write_image(files["png"], static.astype(np.float32))
