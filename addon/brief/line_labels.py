"""Labels of lines on the map sheet."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import context
from .context import Context
from .map_frame import MapFrame

if TYPE_CHECKING:
    from .sheet_map import Content

_SHARES = (0.5, 0.33, 0.67, 0.15, 0.85)  # places along a line, best first


def write(made: Content, each: Context) -> None:
    """Label lines if there is space, each name of a file once."""
    done: set[str] = set()
    for feature in each.features:
        label = context.label(feature)
        for line in feature.lines:
            if label in done or not label or len(line) < 2:
                continue
            if any(made.label(x, y, 0.3, [label]) for x, y in _anchors(made.frame, line)):
                done.add(label)


def _anchors(frame: MapFrame, line: NDArray[np.float64]) -> Iterator[tuple[float, float]]:
    """Find places for the label of a line: at its middle, then towards its ends, mm on the sheet."""
    x, y = frame.place(line[:, 1], line[:, 0])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    for share in _SHARES:
        at = share * along[-1]
        place = float(np.interp(at, along, x)), float(np.interp(at, along, y))
        if frame.contains(*place):
            yield place
