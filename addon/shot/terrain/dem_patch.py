"""An elevation model close to the cameras: heights between the points of the ground's grid."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .apron import Fields
from .elevation import Elevation, between, ramp

_FINEST = 2.0  # m between points
_MOST = 6_000_000  # points
_FADE = 8  # points beside a gap, over which the model gives way to invented relief


class Patch(NamedTuple):
    """Heights of a part of the ground's grid, as `terrain.Surface` takes them."""

    row: int
    column: int
    parts: int
    offset: NDArray[np.float32]
    share: NDArray[np.float32]

    @property
    def place(self) -> tuple[slice, slice]:
        """The cells of the grid that it covers."""
        rows, columns = ((side - 1) // self.parts for side in self.offset.shape)
        return slice(self.row, self.row + rows), slice(self.column, self.column + columns)

    def hollows(self) -> NDArray[np.float32]:
        """How far (m) the lowest point of each cell is below the grid's bilinear ground, 0 or more."""
        below = -np.minimum(self.offset, 0.0) * self.share
        for axis in (0, 1):
            count = below.shape[axis] - 1
            edge = below.take(range(self.parts, count + 1, self.parts), axis)
            inner = np.maximum.reduceat(below.take(range(count), axis), range(0, count, self.parts), axis)
            below = np.maximum(inner, edge)
        return below


def patch(
    fields: Fields,
    share: NDArray,
    relief: Elevation,
    cell: tuple[float, float],
    near: tuple[slice, slice],
) -> Patch | None:
    """The model's heights in these rows and columns of the grid, less the apron's; None where there are none.

    As fine as the model, or as so many points allow.

    Parameters
    ----------
    share
        (ny, nx) 0..1, how far the grid's heights are the model's.
    """
    place = tuple(_inner(part, side, fields.margin) for part, side in zip(near, share.shape, strict=True))
    if min(part.stop - part.start for part in place) < 2 or not share[place].any():
        return None
    parts = _parts(relief.model.resolution, cell, share[place].size)
    if parts == 1:
        return None
    axes = [
        np.linspace(axis[part.start], axis[part.stop - 1], (part.stop - part.start - 1) * parts + 1)
        for axis, part in zip((fields.latitude, fields.longitude), place, strict=True)
    ]
    index = [np.arange(len(axis)) / parts for axis in axes]
    offset = relief.read(*axes) - between(fields.elevation[place].astype(np.float32), *index)
    known = np.isfinite(offset)
    counts = ramp(known, _FADE) * between(share[place].astype(np.float32), *index)
    return Patch(place[0].start, place[1].start, parts, np.where(known, offset, np.float32(0.0)), counts)


def _inner(part: slice, side: int, margin: int) -> slice:
    """Those of some rows or columns that are no apron."""
    return slice(max(part.start, margin), min(part.stop, side - margin))


def _parts(resolution: float, cell: tuple[float, float], cells: int) -> int:
    """Points to a cell, a power of two."""
    wanted = max(cell) / max(resolution, _FINEST)
    allowed = np.sqrt(_MOST / cells)
    return 2 ** max(int(np.floor(min(np.ceil(np.log2(max(wanted, 1.0))), np.log2(max(allowed, 1.0))))), 0)
