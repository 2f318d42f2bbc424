"""Depth pass: distance to terrain and trees, m, along the camera's axis and along the ray.

The EXR has two channels, `planar` and `range`. Flames and smoke are left out, as they have no surface. One
ray goes through each pixel's centre, so no pixel averages near and far. The sky is 1e10 m, as in all of
Blender. A panorama has no axis: both channels are the distance from mid-eye.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import Files, RenderedPass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot


def finish(files: Files, _needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Add the range to the rendered planar depth."""
    import numpy as np
    from firetwin_core import sensor

    from ..cameras import pixel_rays

    planar = sensor.read_image(files["exr"])[..., 0]
    both = np.stack([planar, pixel_rays.ranges(pixel_rays.path_of(shot, camera), frame, planar)], axis=-1)
    about = {"Comment": "m; planar: along the camera's axis, range: along the line of sight"}
    sensor.write_image(files["exr"], both, about, ["planar", "range"])


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
    finish=finish,
)
