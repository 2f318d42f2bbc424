"""Depth pass: distance to terrain and trees, m, along the camera's axis and along the ray.

The EXR has two channels, `planar` and `range`. Flames and smoke are excluded, as they have no surface. One
ray goes through each pixel's centre, so no pixel averages near and far. The sky is 1e10 m, as everywhere in
Blender. A panorama has no axis: both channels are the distance from mid-eye.
"""

from __future__ import annotations

from . import RenderedPass

PASS = RenderedPass(
    name="depth",
    order=20,
    help="Depth of terrain and trees, along the axis and along the line of sight, m, 32-bit EXR",
    files=("exr",),
    socket="Depth",
    layer_property="use_pass_z",
    excludes=("smoke", "fire"),
    samples=1,
    pixel_centres=True,
    geometry_only=True,
    aspects=frozenset({"time", "camera", "picture", "terrain", "forest", "stations"}),
    finished=True,
)
