"""Which way the ground and the trees face: x east, y north and z up of a unit vector in the scene's frame.

Flames and smoke are left out, as they have no surface. One ray goes through the middle of each pixel. Of the
sky all are 0. It is the normal of the mesh; what materials add to it in small is not in it.
"""

from __future__ import annotations

from . import Pass

PASS = Pass(
    name="normal",
    order=25,
    help="Surface normals of terrain and trees (east, north, up), 32-bit EXR",
    files=("exr",),
    output="Normal",
    enable="use_pass_normal",
    leaves_out=("smoke", "fire"),
    samples=1,
    channels="colour",
    pixel_centres=True,
    shows=frozenset({"time", "camera", "picture", "terrain", "forest"}),
)
