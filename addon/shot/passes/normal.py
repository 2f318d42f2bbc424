"""Which way the ground and the trees face: x east, y north and z up of a unit vector in the scene's frame.

Flames and smoke are left out, as they have no surface. One ray goes through the middle of each pixel. Of the
sky all are 0. It is the normal of the mesh; what materials add to it in small is not in it.
"""

from __future__ import annotations

from . import RenderedPass

PASS = RenderedPass(
    name="normal",
    order=25,
    help="Surface normals of terrain and trees (east, north, up), 32-bit EXR",
    files=("exr",),
    socket="Normal",
    layer_property="use_pass_normal",
    excludes=("smoke", "fire"),
    samples=1,
    channels="colour",
    pixel_centres=True,
    aspects=frozenset({"time", "camera", "picture", "terrain", "forest"}),
)
