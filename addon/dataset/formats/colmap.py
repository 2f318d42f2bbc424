"""COLMAP: text model of each run, without points. Poses are world-to-camera, with the scalar first.

Camera axes as in OpenCV: x right, y down, z forwards. The first pixel has its centre at (0.5, 0.5).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath

import numpy as np

from .. import axes
from ..truth import Truth
from . import common

FORMAT = {"help": "colmap/: COLMAP text model of each run, without points"}
ORDER = 80
FOLDER = "colmap"


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write one model for each run; each sample has a separate camera."""
    for run, members in common.by_run(samples).items():
        folder = out / FOLDER / run
        cameras = ["# CAMERA_ID, MODEL, WIDTH, HEIGHT, fx, fy, cx, cy"]
        images = ["# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; a line of points follows: empty"]
        for number, truth in enumerate(members, 1):
            lens = truth.camera
            numbers = (lens.fx, lens.fy, lens.cx, lens.cy)
            cameras.append(f"{number} PINHOLE {lens.width} {lens.height} {common.numbers(numbers)}")
            images += [f"{number} {_pose(truth)} {number} {PurePosixPath(common.picture(truth)).name}", ""]
        common.write_lines(folder / "cameras.txt", cameras)
        common.write_lines(folder / "images.txt", images)
        common.write_lines(folder / "points3D.txt", ["# no points"])


def _pose(truth: Truth) -> str:
    pose = axes.world_to_opencv(np.array(truth.camera.camera_to_world))
    return common.numbers((*axes.quaternion(pose), *pose[:3, 3]))
