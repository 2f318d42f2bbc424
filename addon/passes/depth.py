"""Depth pass: distance to terrain and trees, m, along the camera's axis and along the ray.

The EXR has two channels, `planar` and `range`. Flames and smoke are excluded, as they have no surface. One
ray goes through each pixel's centre, so no pixel averages near and far. The sky is 1e10 m, as everywhere in
Blender. A panorama has no axis: both channels are the distance from mid-eye.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..shot import exr_tags
from ..shot.cameras import pixel_rays
from ..shot.passes import SURFACES, Files, RenderedPass
from ..shot.shot import Shot

ORDER = 20
HELP = "Depth of terrain and trees, along the axis and along the line of sight, m, 32-bit EXR"

PASS = RenderedPass(
    files=("exr",),
    socket="Depth",
    layer_property="use_pass_z",
    excludes=("smoke", "fire"),
    samples=1,
    pixel_centres=True,
    geometry_only=True,
    shares_rays=True,
    aspects=SURFACES,
)


def march(eye: Any, _frame: int) -> NDArray:
    """Return the planar depth (h, w), m, at pixel centres."""
    return eye.channels["Depth"][..., 0]


def finish(files: Files, _needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Add the range to the rendered planar depth."""
    planar = sensor.read_image(files["exr"])[..., 0]
    both = np.stack(
        [planar, pixel_rays.ranges(pixel_rays.path_of(shot.paths, camera), frame, planar)], axis=-1
    )
    said = "m; planar: along the camera's axis, range: along the line of sight"
    about = exr_tags.attributes(shot, camera, frame, said)
    sensor.write_image(files["exr"], both, about, ["planar", "range"])
