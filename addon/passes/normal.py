"""Normal pass: surface normals of terrain and trees, unit vectors x east, y north, z up in the scene's frame.

Flames and smoke are excluded, as they have no surface; firebrands are not. One ray goes through each pixel's
centre, as in `masks`, which shares its rays. The sky is 0. It is the mesh normal, without bump maps of
materials.

Normals are not averaged over the pixel. In foliage, whose leaves are smaller than a pixel, neighbouring
pixels have unrelated normals, and these change from frame to frame as the camera moves: relighting by them
flickers there. A mean of such normals is not the normal of any surface. Ground, buildings and near trunks
are smooth.
"""

from __future__ import annotations

from ..shot.passes import SURFACES, RenderedPass

ORDER = 25
HELP = "Surface normals of terrain and trees (east, north, up), 32-bit EXR"

PASS = RenderedPass(
    files=("exr",),
    socket="Normal",
    layer_property="use_pass_normal",
    excludes=("smoke", "fire"),
    samples=1,
    channels="colour",
    pixel_centres=True,
    aspects=SURFACES | {"fire"},
)
