"""Text as pixels, in Blender's typeface, which covers most scripts.

`blf` and `imbuf` exist only once `bpy` is imported, so functions import them.
"""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from . import compat


@dataclass(frozen=True)
class Line:
    """A line of text: its size, and its left end and baseline from the lower left corner, pixels."""

    text: str
    size: float
    left: float
    base: float


def measure_width(text: str, size: float) -> float:
    """Measure the width of a line of text, pixels."""
    import blf

    blf.size(typeface(), size)
    return float(blf.dimensions(typeface(), text)[0])


def draw_lines(lines: Sequence[Line], width: int, height: int) -> NDArray[np.float32]:
    """Draw lines of text as opacity (height, width), 0..1, with the top row first."""
    import blf
    import imbuf

    image = imbuf.new((width, height))
    blf.color(typeface(), 1.0, 1.0, 1.0, 1.0)
    with blf.bind_imbuf(typeface(), image):
        for line in lines:
            blf.size(typeface(), line.size)
            blf.position(typeface(), line.left, line.base, 0.0)
            blf.draw_buffer(typeface(), line.text)
    with tempfile.TemporaryDirectory(prefix="firetwin-") as folder:
        path = Path(folder, "text.png")
        imbuf.write(image, filepath=str(path))
        return np.asarray(sensor.read_image(path)[..., -1])


@functools.cache
def typeface() -> int:
    """Load Blender's typeface with its fallbacks, and return its number."""
    import blf

    path = compat.typeface_path()
    return max(int(blf.load(path)) if path else 0, 0)
