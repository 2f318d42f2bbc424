"""Fire fronts: burned state at points, and the front as a contour line, at any time.

Both match the scores (see `run.score.shapes`): the front moves at constant speed between two cell centres,
and a front that has stopped lies half-way between them.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core.run import Run
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ...run import areas, times
from ...run.score.grid import ScoreGrid
from ...run.score.shapes import mirrored, wider
from .observed import ABOVE

if TYPE_CHECKING:
    from ..shot import Shot

COLOURS = ("#b8f53d", "#ff4fd0", "#5fd7ff", "#ffffff")
"""Front colours: the first run, then the others in order. Flames and burned ground have other colours."""
_FINE = 80.0  # m; a coarser grid is subdivided so that lines follow the terrain
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


class Reach:
    """Burned area of a run as a function of time."""

    def __init__(self, run: Run) -> None:
        self.run = run
        grid = ScoreGrid.of(run)
        self.latitude, self.longitude = wider(grid.latitude), wider(grid.longitude)
        self.arrival = np.pad(grid.arrival, 1, constant_values=np.nan)
        self.divided = max(1, int(np.ceil(max(grid.cell) / _FINE)))

    @cached_property
    def _middle(self) -> float:
        return 0.5 * float(self.longitude[0] + self.longitude[-1])

    def burned(self, latitude: ArrayLike, longitude: ArrayLike, time: float) -> Array:
        """Burned state of points (degrees) at a model time (s): 1 burned, 0 not, NaN outside of the grid."""
        longitude = areas.turned(longitude, self._middle)
        row, column = (
            np.interp(np.asarray(at, np.float64), axis, np.arange(len(axis)), left=np.nan, right=np.nan)
            for at, axis in ((latitude, self.latitude), (longitude, self.longitude))
        )
        inside = np.isfinite(row) & np.isfinite(column)
        since = bilinear(mirrored(self.arrival - time), np.nan_to_num(row), np.nan_to_num(column))
        return np.where(inside, since <= 0.0, np.nan)

    def line(self, time: float) -> tuple[Array, Array, NDArray[np.int64]]:
        """Front contour at a model time (s): latitude, longitude (n,) and the index of each point's next."""
        burned = self.arrival <= time
        if not burned.any():
            return np.empty(0), np.empty(0), np.empty(0, np.int64)
        box = tuple(
            slice(max(int(found[0]) - 2, 0), int(found[-1]) + 3)
            for found in (np.flatnonzero(burned.any(axis)) for axis in (1, 0))
        )
        since = mirrored(self.arrival[box] - time)
        row, column = (np.linspace(0, count - 1, (count - 1) * self.divided + 1) for count in since.shape)
        if self.divided > 1:
            since = bilinear(since, *np.meshgrid(row, column, indexing="ij"))
        y, x, after = contour(since)
        latitude, longitude = (
            np.interp(at, np.arange(len(fine)), np.interp(fine, np.arange(axis[part].size), axis[part]))
            for at, fine, axis, part in (
                (y, row, self.latitude, box[0]),
                (x, column, self.longitude, box[1]),
            )
        )
        return latitude, longitude, after


@functools.lru_cache(maxsize=len(COLOURS))
def reach(run: Run) -> Reach:
    """Burned area of a run; those of the last runs are cached."""
    return Reach(run)


def contour(field: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Zero contour of a field (ny, nx): fractional rows and columns (n,), and the index of each point's next.

    Marching squares with linear interpolation between neighbours. Lines are closed. Values of 0 or less lie
    on their left, with columns to the right and rows up. The contour must not reach the field's border.
    """
    inside = field <= 0.0
    corners = [inside[:-1, :-1], inside[:-1, 1:], inside[1:, 1:], inside[1:, :-1]]
    number = np.arange(field.size).reshape(field.shape)
    sides = [number[:-1, :-1], number[:-1, 1:] + field.size, number[1:, :-1], number[:-1, :-1] + field.size]
    leaves = [corners[k] & ~corners[(k + 1) % 4] for k in range(4)]
    enters = [~corners[k] & corners[(k + 1) % 4] for k in range(4)]
    crossed = np.sum(leaves, axis=0, dtype=np.int8) == 2
    joined = 0.25 * (field[:-1, :-1] + field[:-1, 1:] + field[1:, 1:] + field[1:, :-1]) <= 0.0
    from_sides, to_sides = [], []
    for k in range(4):
        for step in (1, 2, 3):
            other = (k + step) % 4
            mask = leaves[k] & enters[other]
            if step == 2:
                mask &= ~crossed
            else:
                mask &= ~crossed | (joined if step == 1 else ~joined)
            from_sides.append(sides[k][mask])
            to_sides.append(sides[other][mask])
    here, there = np.concatenate(from_sides), np.concatenate(to_sides)
    points = np.unique(here)
    after = np.empty(len(points), np.int64)
    after[np.searchsorted(points, here)] = np.searchsorted(points, there)
    upright = points >= field.size
    row, column = np.divmod(points % field.size, field.shape[1])
    low, high = field[row, column], field[row + upright, column + ~upright]
    part = low / (low - high)
    return row + part * upright, column + part * ~upright, after


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
