"""Wipe: pictures of two shots in one, on both sides of a line that moves across in the time of a shot."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from .. import output
from ..shot.terrain import noise

_ENDS = 0.92, 0.08  # of the width, the line at the start and at the end
_LINE = 1 / 320  # of the width, the line


Picture = tuple[Path, Path, Path]
"""Files of a picture, and of those at its left and its right."""


def write(pictures: Sequence[Picture], overwrite: bool) -> None:
    """Write the pictures of a shot, each from two."""
    read = functools.lru_cache(maxsize=2)(_read)  # successive pictures have the same ones
    for number, (path, left, right) in enumerate(pictures):
        picture = join(read(left), read(right), number / max(len(pictures) - 1, 1))
        output.write(path, functools.partial(_save, picture), overwrite)


def _save(picture: NDArray[np.float32], path: Path) -> None:
    sensor.write_image(path, picture)


def join(left: NDArray[np.float32], right: NDArray[np.float32], part: float) -> NDArray[np.float32]:
    """Join two pictures (h, w, 3) at a part (0 to 1) of a shot; the line moves from right to left."""
    width = left.shape[1]
    share = float(noise.smoothstep(0.0, 1.0, np.array(part)))
    at = round((_ENDS[0] + (_ENDS[1] - _ENDS[0]) * share) * width)
    picture = np.concatenate([left[:, :at], right[:, at:]], axis=1)
    picture[:, at : at + max(round(_LINE * width), 1)] = 1.0
    return picture


def _read(path: Path) -> NDArray[np.float32]:
    return sensor.read_image(path)[..., :3]
