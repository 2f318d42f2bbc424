"""nerfstudio: `transforms.json` of each run, with intrinsics by frame.

Its camera axes and pixel centres are ours (see `axes`), so matrices are copied. The fire differs between
frames: a reconstruction of the ground works best with samples of one time.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..truth import Truth
from . import common

FORMAT = {"help": "nerfstudio/: transforms.json of each run"}
ORDER = 70
FOLDER = "nerfstudio"


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write one index for each run."""
    for run, members in common.by_run(samples).items():
        frames = [_frame(truth) for truth in members]
        common.write_json(
            out / FOLDER / run / "transforms.json", {"camera_model": "OPENCV", "frames": frames}
        )


def _frame(truth: Truth) -> dict[str, Any]:
    camera = truth.camera
    return {
        "file_path": f"../../{common.picture(truth)}",
        "w": camera.width,
        "h": camera.height,
        "fl_x": camera.fx,
        "fl_y": camera.fy,
        "cx": camera.cx,
        "cy": camera.cy,
        "transform_matrix": camera.camera_to_world,
        "time_utc": truth.utc,
        "split": truth.split,
    }
