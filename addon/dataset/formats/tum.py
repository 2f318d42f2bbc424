"""TUM: trajectory of each run as camera-to-world poses, scalar last. The time is the number of the sample.

Samples are not a sequence, and can have equal model times, which tools for trajectories reject. `camera.txt`
has the lens of each sample. Axes and pixel centres are OpenCV's: x right, y down, z forwards; the first pixel
has its centre at (0, 0), so cx and cy are 0.5 pixels less than in the metadata.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .. import axes
from ..truth import Truth
from . import common

FORMAT = {"help": "tum/: TUM trajectory of each run, with the number of the sample as its time"}
ORDER = 90
FOLDER = "tum"


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write trajectory, list of pictures and lenses for each run."""
    for run, members in common.by_run(samples).items():
        poses = ["# number tx ty tz qx qy qz qw"]
        pictures = ["# number filename"]
        lenses = ["# number width height fx fy cx cy"]
        for truth in sorted(members, key=lambda truth: truth.index):
            lens, number = truth.camera, f"{truth.index}.0"
            pose = axes.opencv_to_world(np.array(lens.camera_to_world))
            w, x, y, z = axes.quaternion(pose)
            poses.append(f"{number} {common.numbers((*pose[:3, 3], x, y, z, w))}")
            pictures.append(f"{number} ../../{common.picture(truth)}")
            centre = (lens.cx - axes.OPENCV_CENTRE, lens.cy - axes.OPENCV_CENTRE)
            lenses.append(
                f"{number} {lens.width} {lens.height} {common.numbers((lens.fx, lens.fy, *centre))}"
            )
        for name, lines in (("groundtruth", poses), ("rgb", pictures), ("camera", lenses)):
            common.write_lines(out / FOLDER / run / f"{name}.txt", lines)
