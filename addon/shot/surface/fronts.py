"""Fire fronts of the runs of a shot, as lines on its terrain (see `run.front`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...run import areas, times
from ...run.front import reach
from .observed import ABOVE

if TYPE_CHECKING:
    from ..shot import Shot

COLOURS = ("#b8f53d", "#ff4fd0", "#5fd7ff", "#ffffff")
"""Front colours: the first run, then the others in order. Flames and burned ground have other colours."""
_MAX_TIMES = 480  # times at most for which a front is drawn

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lines:
    """Fire front at several times, draped on the terrain.

    Attributes
    ----------
    points
        (n, 3) m in the scene.
    after
        (n,) index of the next point of its closed line; the burned side is on the left.
    start, end
        (n,) model times, s of the shot's run, between which a point's line is drawn.
    """

    points: Array
    after: NDArray[np.int64]
    start: Array
    end: Array


def lines(shot: Shot, run: Run) -> Lines:
    """Fronts of a run on the terrain of a shot, one for each built frame."""
    moments = shot.built_times
    if len(moments) > _MAX_TIMES:
        moments = np.linspace(moments[0], moments[-1], _MAX_TIMES)
    ends = np.concatenate([[-np.inf], 0.5 * (moments[1:] + moments[:-1]), [np.inf]])
    fire, shift = reach(run), times.seconds(run, times.utc(shot.run, 0.0))
    parts, count = [], 0
    for time, start, end in zip(moments, ends[:-1], ends[1:], strict=True):
        latitude, longitude, after = fire.line(time + shift)
        span = np.full((len(after), 2), (start, end))
        parts.append((latitude, longitude, after + count, span))
        count += len(after)
    latitude, longitude, after, span = (np.concatenate(each) for each in zip(*parts, strict=True))
    grid = shot.ground.fields.longitude
    longitude = areas.turned(longitude, 0.5 * float(grid[0] + grid[-1]))
    points = shot.ground.point(latitude, longitude, ABOVE) if count else np.empty((0, 3))
    return Lines(points, after, *span.T)


def colours(shot: Shot) -> dict[str, str]:
    """Front colour of each run of the scene file, by name; the first run comes first."""
    first = getattr(shot, "first", shot)
    return dict(zip((first.label, *first.others), COLOURS, strict=False))
