"""Normal pass: surface normals of terrain and trees, unit vectors x east, y north, z up in the scene's frame.

Flames and smoke are excluded, as they have no surface. One ray goes through each pixel's centre. The sky is
0. It is the mesh normal, without bump maps of materials.
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
    aspects=frozenset({"time", "camera", "picture", "terrain", "forest", "stations"}),
)
