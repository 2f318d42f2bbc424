"""Fire fronts of an export: at round local times of the run, and at frames of the film."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np

from ..geometry.polygons import area, inside
from ..run import fronts
from ..run.fronts import Line
from ..shot.shot import Shot
from .request import ExportRequest

MOST_FRAMES = 24
"""Maximum number of fronts at frames of the film."""

_CORNERS = 64  # of a hole, which are tested

Polygon = list[Line]


@dataclass(frozen=True)
class DatedFront:
    """Front that is shown from a time until the next front.

    Attributes
    ----------
    time
        Model time, s.
    begin, end
        UTC; `end` is None for the last front.
    lines
        Closed lines (n, 2), degrees east and north; burned ground is on their left.
    area
        Burned area, m2.
    """

    time: float
    begin: datetime
    end: datetime | None
    lines: list[Line]
    area: float

    @property
    def polygons(self) -> list[Polygon]:
        """Burned area as polygons: the outer ring, anticlockwise, then holes."""
        return polygons(self.lines)


def find(request: ExportRequest) -> list[DatedFront]:
    """Find the fronts of a request: see `of_shot`."""
    return of_shot(request.shot, request.frames)


def of_shot(shot: Shot, frames: Sequence[int]) -> list[DatedFront]:
    """Find the fronts of a shot's run by time, without those before the fire.

    Parameters
    ----------
    frames
        Frames of the film whose times have fronts, up to `MOST_FRAMES` of them.
    """
    run = shot.run
    zone = shot.settings.time.zone
    every = -(-len(frames) // MOST_FRAMES)
    film = [shot.frames.time(frame) for frame in frames[::every]]
    low, high = shot.frames.span
    moments = {*(each for each in fronts.choose_times(run, zone) if not low < each < high), *film}
    found, _ = fronts.at_times(run, sorted(moments))
    ends = [*(front.utc for front in found[1:]), None]
    return [
        DatedFront(front.time, front.utc, end, front.lines, front.area)
        for front, end in zip(found, ends, strict=True)
        if front.lines
    ]


def polygons(lines: list[Line]) -> list[Polygon]:
    """Group closed lines into polygons: each hole (clockwise) belongs to the smallest ring around it."""
    signed = [area(line) for line in lines]
    outer = sorted((k for k, each in enumerate(signed) if each > 0.0), key=lambda k: signed[k])
    rings_of = {k: [lines[k]] for k in outer}
    for k, each in enumerate(signed):
        if each < 0.0:
            owner = next((j for j in outer if signed[j] >= -each and _is_inside(lines[k], lines[j])), None)
            if owner is not None:
                rings_of[owner].append(lines[k])
    return [rings_of[k] for k in sorted(outer)]


def _is_inside(inner: Line, ring: Line) -> bool:
    """Check whether most corners of a line are inside a ring."""
    return bool(np.mean(inside([ring], inner[: -1 : -(-len(inner) // _CORNERS)])) > 0.5)
