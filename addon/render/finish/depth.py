"""Add the range along the line of sight to the rendered planar depth."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor

from ...shot.cameras import pixel_rays
from ...shot.shot import Shot
from .. import exr_tags
from . import Files


def finish(files: Files, _needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Add the range to the rendered planar depth."""
    planar = sensor.read_image(files["exr"])[..., 0]
    both = np.stack(
        [planar, pixel_rays.ranges(pixel_rays.path_of(shot.paths, camera), frame, planar)], axis=-1
    )
    said = "m; planar: along the camera's axis, range: along the line of sight"
    about = exr_tags.attributes(shot, camera, frame, said)
    sensor.write_image(files["exr"], both, about, ["planar", "range"])
