"""Cells of the terrain grid on which flames may be seen at one time.

Needs no Blender.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ..terrain.terrain import UNKNOWN, box
from . import flame_phase, flame_state

AHEAD = 2.2  # flame lengths ahead of the front over which flames lean
_LONG_BEFORE, _LONG_AFTER = 1.0e4, 1.0e4  # s, ages beyond these are not looked at
_SLOWER = 1.2  # factor on times, for places between nodes at which the front is slower than at both

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class FlameWindow:
    """Part of the terrain grid near the fronts of a time.

    Attributes
    ----------
    corner
        First row and column of the part.
    came, lead, lag, pace, length
        Arrival (s), the times before and after it in which flames may reach a place (s), the inverse of the
        rate of spread (s/m), and the mean flame length (m), all (rows, columns).
    time
        s
    """

    corner: tuple[int, int]
    came: Array
    lead: Array
    lag: Array
    pace: Array
    length: Array
    time: float

    @cached_property
    def cells(self) -> Mask:
        """Mask of the quads between nodes on which flames may be seen."""
        lead, lag = dilate(self.lead, 1), dilate(self.lag, 1)
        soon, late = (self.came - lead) <= self.time, (self.came + lag) >= self.time
        soon, late = (each[1:, 1:] | each[1:, :-1] | each[:-1, 1:] | each[:-1, :-1] for each in (soon, late))
        return soon & late

    @cached_property
    def _count(self) -> NDArray[np.int64]:
        total = np.cumsum(np.cumsum(self.cells, axis=0, dtype=np.int64), axis=1)
        return np.pad(total, ((1, 0), (1, 0)))

    def touches(self, low: Array, high: Array) -> Mask:
        """Return a mask (n,) of rectangles with flames, from rows and columns (n, 2) to rows and columns."""
        first = np.floor(low).astype(np.int64) - self.corner
        last = np.floor(high).astype(np.int64) + 1 - self.corner
        rows, columns = self.cells.shape
        (i, j), (k, m) = (
            (np.clip(each[:, 0], 0, rows), np.clip(each[:, 1], 0, columns)) for each in (first, last)
        )
        count = self._count
        return (count[k, m] - count[i, m] - count[k, j] + count[i, j]) > 0

    def near(self, row: Array, column: Array, around: float) -> tuple[Mask, Mask]:
        """Return masks of places, at rows and columns, with flames near, and of places burned out.

        Parameters
        ----------
        around
            Distance (m) by which places count as near before and after flames reach them.
        """
        row, column = row - self.corner[0], column - self.corner[1]
        rows, columns = self.came.shape
        inside = (row >= 0.0) & (row <= rows - 1.0) & (column >= 0.0) & (column <= columns - 1.0)
        row, column = np.clip(row, 0.0, rows - 1.0), np.clip(column, 0.0, columns - 1.0)
        came, lead, lag, pace = (
            bilinear(each, row, column) for each in (self.came, self.lead, self.lag, self.pace)
        )
        lead, lag = (_SLOWER * each + around * pace for each in (lead, lag))
        out = came + lag < self.time
        return inside & ~out & (came - lead <= self.time), inside & out

    def typical_length(self, row: Array, column: Array) -> Array:
        """Return the mean flame length (m) at rows and columns."""
        rows, columns = self.length.shape
        row, column = row - self.corner[0], column - self.corner[1]
        return bilinear(self.length, np.clip(row, 0.0, rows - 1.0), np.clip(column, 0.0, columns - 1.0))


def find(shot: Any, time: float) -> FlameWindow | None:
    """Return the part of the grid on which flames may be seen at a time (s); None if there is none."""
    ground, front = shot.ground, shot.full.front
    came = ground.burn_time
    recent = (came < time + _LONG_BEFORE) & (came > time - _LONG_AFTER) & (came < 0.5 * UNKNOWN)
    part = box(recent, 2)
    if part is None:
        return None
    recent = recent[part]
    place = [at + lines.start for at, lines in zip(np.nonzero(recent), part, strict=True)]
    row, column = (each.astype(np.float64) for each in place)
    speed, residence = ground.spread(row, column), np.nan_to_num(front.residence[place[0], place[1]])
    even = flame_state.even_length(shot, row, column)
    longest = np.minimum(flame_state.TALLEST * even, flame_state.LONGEST)
    scale = flame_state.pattern_scale(shot)
    far = np.sqrt(2.0) * scale * flame_state.RAGGED[1]
    lead, lag, pace, length = np.zeros((4, *recent.shape))
    lead[recent] = (AHEAD * longest + far) / speed
    lag[recent] = flame_phase.last_age(speed, residence, longest) + (longest + far) / speed
    pace[recent] = 1.0 / speed
    length[recent] = even
    window = FlameWindow((part[0].start, part[1].start), came[part], lead, lag, pace, length, time)
    return window if window.cells.any() else None
