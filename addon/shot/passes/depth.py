"""Distance along the camera's axis, in metres, to ground and trees.

Flames and smoke are left out, as they have no surface. One ray goes through the middle of each pixel, so
that no pixel is a mean of near and far. The sky is 1e10 m, as everywhere in Blender.
"""

from __future__ import annotations

from . import Pass

PASS = Pass(
    name="depth",
    order=20,
    help="Metres to ground and trees, 32-bit EXR",
    files=("exr",),
    output="Depth",
    enable="use_pass_z",
    leaves_out=("smoke", "fire"),
    samples=1,
    pixel_centres=True,
    shows=frozenset({"time", "camera", "picture", "ground", "forest"}),
)
