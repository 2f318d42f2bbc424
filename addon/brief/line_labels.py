"""Labels of lines on the map sheet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import context
from .context import Context
from .map_frame import MapFrame

if TYPE_CHECKING:
    from .sheet_map import Content

Array = NDArray[np.float64]

_SHARES = (0.5, 0.33, 0.67, 0.15, 0.85)  # places along a line, best first


def write(content: Content, each: Context) -> None:
    """Label lines if there is space, each name of a file once; routes of resources have numbers."""
    done: set[str] = set()
    for label, line in (*_names(each), *_numbers(each)):
        if label in done or not label or len(line) < 2:
            continue
        if any(content.label(x, y, 0.3, [label]) for x, y in _anchors(content.frame, line)):
            done.add(label)


def _names(each: Context) -> Iterator[tuple[str, Array]]:
    for feature in each.features:
        if context.NUMBER not in feature.properties:
            yield from ((context.label(feature), line) for line in feature.lines)


def _numbers(each: Context) -> Iterator[tuple[str, Array]]:
    """Return the numbers of each route, such as "3-7, 9": resources of a station share one."""
    routes: dict[bytes, tuple[list[int], Array]] = {}
    for feature in each.features:
        if context.NUMBER in feature.properties:
            for line in feature.lines:
                shared, _ = routes.setdefault(line.tobytes(), ([], line))
                shared.append(int(feature.properties[context.NUMBER]))
    yield from ((_ranges(sorted(shared)), line) for shared, line in routes.values())


def _ranges(numbers: Sequence[int]) -> str:
    """Format ascending numbers as ranges."""
    ranges: list[list[int]] = []
    for number in numbers:
        if ranges and number == ranges[-1][1] + 1:
            ranges[-1][1] = number
        else:
            ranges.append([number, number])
    return ", ".join(f"{first}" if first == last else f"{first}-{last}" for first, last in ranges)


def _anchors(frame: MapFrame, line: NDArray[np.float64]) -> Iterator[tuple[float, float]]:
    """Find places for the label of a line: at its middle, then towards its ends, mm on the sheet."""
    x, y = frame.place(line[:, 1], line[:, 0])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    for share in _SHARES:
        at = share * along[-1]
        place = float(np.interp(at, along, x)), float(np.interp(at, along, y))
        if frame.contains(*place):
            yield place
