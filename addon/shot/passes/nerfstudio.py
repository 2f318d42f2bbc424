"""Training pass: depth and mask of each frame as nerfstudio reads them.

The NPY file has the planar depth in millimetres, float32 (h, w), with 0 in the sky; nerfstudio multiplies it
by `depth_unit_scale_factor`, 0.001 by default. The PNG has one channel: 255 where a pixel shows terrain,
trees or buildings, and 0 for sky, smoke and fire, which have no fixed surface. nerfstudio trains on non-zero
pixels. The index `transforms.json` names both files as `depth_file_path` and `mask_path`; it needs `rgb` and
`pose`.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="nerfstudio",
    order=42,
    help="Depth (mm, NPY) and mask of static surfaces (PNG) of each frame for nerfstudio, "
    "listed in transforms.json with rgb and pose",
    files=("npy", "png"),
    single_view=True,
    needs=("depth", "masks"),
)
