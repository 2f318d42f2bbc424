"""Pose pass: sidecar of each frame with extrinsics, intrinsics, time and units, for machines.

`camera_to_world` maps camera coordinates (x right, y up, z backwards: the axes of OpenGL, Blender and
nerfstudio) to metres east, north and up of `origin`, the WGS84 point of the scene's tangent plane. Pixel
coordinates count from the picture's upper left corner, u to the right and v down; the first pixel's centre is
(0.5, 0.5). A camera point (x, y, z) projects to u = cx + fx x / d and v = cy - fy y / d, where d = -z is its
planar depth. In an orthographic projection u and v do not depend on d, and fx and fy are pixels per metre.
Lenses are free of distortion. The camera in Blender agrees within 0.05 pixels. `files` are the files of the
camera's other passes, relative to the sidecar. `credits` and `services` are the credits that the picture
needs. `tiles`, if 3D Tiles are shown, has missing tiles and the screen-space error of the selection, pixels.

In a panorama the left eye's picture, `eye` pixels high, is above the right eye's. A direction (x, y, z)
projects to u = cx + fx atan2(x, -z) and v = cy - fy asin(y) in each eye's picture; fx and fy are pixels per
radian, and the eyes are `interocular` metres apart.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="pose",
    order=5,
    help="Camera position, orientation, lens, time and units of each frame, JSON",
    files=("json",),
    aspects=frozenset({"time", "camera", "picture", "terrain", "passes"}),
)
