"""Where the fire of a run is at any moment: at places, and as the line of its front.

Both are those that scores know (see `run.score.shapes`): between two cells' middles the front moves evenly,
and where it has stopped it is half-way.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ...run import areas, times
from ...run.score.grid import Grid
from ...run.score.shapes import mirrored, wider
from ..terrain.terrain import bilinear
from .observed import ABOVE

if TYPE_CHECKING:
    from ..shot import Shot

COLOURS = ("#b8f53d", "#ff4fd0", "#5fd7ff", "#ffffff")
"""Of the first run and of the others in their order; no flame and no burned ground has them."""
_FINE = 80.0  # m; a coarser grid is divided, so that lines follow the ground
_MOST = 480  # moments that a front is drawn at

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lines:
    """A front at several moments, on the ground.

    Attributes
    ----------
    points
        (n, 3) m in the scene.
    after
        (n,) which point comes next on its closed line; the burned side is left.
    start, end
        (n,) model times of the shot's run (s) between which the line of a point is drawn.
    """

    points: Array
    after: NDArray[np.int64]
    start: Array
    end: Array


class Reach:
    """What of a run has burned by when."""

    def __init__(self, run: Run) -> None:
        self.run = run
        grid = Grid.of(run)
        self.latitude, self.longitude = wider(grid.latitude), wider(grid.longitude)
        self.arrival = np.pad(grid.arrival, 1, constant_values=np.nan)
        self.divided = max(1, int(np.ceil(max(grid.cell) / _FINE)))

    @cached_property
    def _middle(self) -> float:
        return 0.5 * float(self.longitude[0] + self.longitude[-1])

    def burned(self, latitude: ArrayLike, longitude: ArrayLike, time: float) -> Array:
        """1 where places (degrees) have burned by a model time (s), 0 where not, NaN outside of the grid."""
        longitude = areas.turned(longitude, self._middle)
        row, column = (
            np.interp(at, axis, np.arange(len(axis)), left=np.nan, right=np.nan)
            for at, axis in ((latitude, self.latitude), (longitude, self.longitude))
        )
        inside = np.isfinite(row) & np.isfinite(column)
        since = bilinear(mirrored(self.arrival - time), np.nan_to_num(row), np.nan_to_num(column))
        return np.where(inside, since <= 0.0, np.nan)

    def line(self, time: float) -> tuple[Array, Array, NDArray[np.int64]]:
        """Latitude and longitude (n,) of the front's points at a model time (s), and which comes next."""
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
        places = (
            np.interp(at, np.arange(len(fine)), np.interp(fine, np.arange(axis[part].size), axis[part]))
            for at, fine, axis, part in (
                (y, row, self.latitude, box[0]),
                (x, column, self.longitude, box[1]),
            )
        )
        return (*places, after)


@functools.lru_cache(maxsize=len(COLOURS))
def reach(run: Run) -> Reach:
    """What of a run has burned by when; that of the last runs asked for is kept."""
    return Reach(run)


def contour(field: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Fractional rows and columns (n,) where a field (ny, nx) is 0, and the index of each point's next.

    Marching squares: the field is even between two neighbours. Lines are closed, with what is 0 or less on
    their left where columns go right and rows up; it must not reach the field's rim.
    """
    inside = field <= 0.0
    corners = [inside[:-1, :-1], inside[:-1, 1:], inside[1:, 1:], inside[1:, :-1]]
    number = np.arange(field.size).reshape(field.shape)
    sides = [number[:-1, :-1], number[:-1, 1:] + field.size, number[1:, :-1], number[:-1, :-1] + field.size]
    leaves = [corners[k] & ~corners[(k + 1) % 4] for k in range(4)]
    enters = [~corners[k] & corners[(k + 1) % 4] for k in range(4)]
    crossed = sum(leave.astype(np.int8) for leave in leaves) == 2
    joined = 0.25 * (field[:-1, :-1] + field[:-1, 1:] + field[1:, 1:] + field[1:, :-1]) <= 0.0
    here, there = [], []
    for k in range(4):
        for step in (1, 2, 3):
            other = (k + step) % 4
            mask = leaves[k] & enters[other]
            mask &= ~crossed | ((joined if step == 1 else ~joined) if step != 2 else False)
            here.append(sides[k][mask])
            there.append(sides[other][mask])
    here, there = np.concatenate(here), np.concatenate(there)
    points = np.unique(here)
    after = np.empty(len(points), np.int64)
    after[np.searchsorted(points, here)] = np.searchsorted(points, there)
    upright = points >= field.size
    row, column = np.divmod(points % field.size, field.shape[1])
    low, high = field[row, column], field[row + upright, column + ~upright]
    part = low / (low - high)
    return row + part * upright, column + part * ~upright, after


def lines(shot: Shot, run: Run) -> Lines:
    """The front of a run over the ground of a shot, at the moments that are built: one line for each."""
    moments = shot.built_times
    if len(moments) > _MOST:
        moments = np.linspace(moments[0], moments[-1], _MOST)
    ends = np.concatenate([[-np.inf], 0.5 * (moments[1:] + moments[:-1]), [np.inf]])
    fire, shift = reach(run), times.seconds(run, times.utc(shot.run, 0.0))
    found, count = [], 0
    for time, start, end in zip(moments, ends[:-1], ends[1:], strict=True):
        latitude, longitude, after = fire.line(time + shift)
        span = np.full((len(after), 2), (start, end))
        found.append((latitude, longitude, after + count, span))
        count += len(after)
    latitude, longitude, after, span = (np.concatenate(each) for each in zip(*found, strict=True))
    grid = shot.ground.fields.longitude
    longitude = areas.turned(longitude, 0.5 * float(grid[0] + grid[-1]))
    points = shot.ground.point(latitude, longitude, ABOVE) if count else np.empty((0, 3))
    return Lines(points, after, *span.T)


def colours(shot: Shot) -> dict[str, str]:
    """The colour of each run of the scene file, the first one's name first."""
    first = getattr(shot, "first", shot)
    return dict(zip((first.label, *first.others), COLOURS, strict=False))
