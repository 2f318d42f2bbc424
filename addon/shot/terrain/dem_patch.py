"""DEM patch: elevation model near the cameras at finer resolution than the terrain grid."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from . import rim
from .apron import TerrainFields
from .elevation import Elevation, ramp
from .raster import Array

_FINEST = 2.0  # m, smallest point spacing
_MOST = 6_000_000  # points at most
_FADE = 8  # points next to a gap over which the model blends into synthetic relief


class HeightPatch(NamedTuple):
    """Heights of a part of the terrain grid, as `terrain.Surface` takes them."""

    row: int
    column: int
    parts: int
    offset: NDArray[np.float32]
    share: NDArray[np.float32]

    @property
    def place(self) -> tuple[slice, slice]:
        """Grid cells that the patch covers."""
        rows, columns = ((side - 1) // self.parts for side in self.offset.shape)
        return slice(self.row, self.row + rows), slice(self.column, self.column + columns)

    def hollows(self) -> NDArray[np.float32]:
        """Depth (m) of each cell's lowest point below the bilinear terrain, 0 or more."""
        below = -np.minimum(self.offset, 0.0) * self.share
        for axis in (0, 1):
            count = below.shape[axis] - 1
            edge = below.take(range(self.parts, count + 1, self.parts), axis)
            inner = np.maximum.reduceat(below.take(range(count), axis), range(0, count, self.parts), axis)
            below = np.maximum(inner, edge)
        return below


def patch(
    fields: TerrainFields,
    share: NDArray,
    relief: Elevation,
    cell: tuple[float, float],
    near: tuple[slice, slice],
) -> HeightPatch | None:
    """Sample the elevation model in these rows and columns, without the apron; None if it has no data there.

    It has the resolution of the model, or as many points as allowed.

    Parameters
    ----------
    share
        Weight of the elevation model in the grid's heights (ny, nx), 0..1.
    """
    assert relief.model
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
    row, column = (np.arange(len(axis)) / parts for axis in axes)
    index = row[:, None], column
    offset = relief.read(*axes) - bilinear(fields.elevation[place], *index).astype(np.float32)
    if relief.tiles is not None:
        offset = _beside_tiles(relief, offset, axes, [fields.latitude[place[0]], fields.longitude[place[1]]])
    known = np.isfinite(offset)
    counts = ramp(known, _FADE) * bilinear(share[place], *index).astype(np.float32)
    return HeightPatch(
        place[0].start, place[1].start, parts, np.where(known, offset, np.float32(0.0)), counts
    )


def _beside_tiles(relief: Elevation, offset: NDArray, axes: list[Array], grid: list[Array]) -> NDArray:
    """Return offsets in full up to the border of tiles, and the elevation model's detail outside of it.

    The grid's own heights meet the tiles there. The model's would not.
    """
    tiles, beside = relief.parts
    on = np.isfinite(tiles.read(*axes))
    if beside.model is not None:
        row, column = (np.interp(at, line, np.arange(len(line))) for at, line in zip(axes, grid, strict=True))
        offset = np.where(on, offset, beside.read(*axes) - bilinear(beside.read(*grid), row[:, None], column))
        return offset.astype(np.float32)
    return rim.continued(np.where(on, offset, np.float32(np.nan)), _FADE)


def _inner(part: slice, side: int, margin: int) -> slice:
    """Clip a range of rows or columns to the grid without its apron."""
    return slice(max(part.start, margin), min(part.stop, side - margin))


def _parts(resolution: float, cell: tuple[float, float], cells: int) -> int:
    """Points per cell, a power of two."""
    wanted = max(cell) / max(resolution, _FINEST)
    allowed = np.sqrt(_MOST / cells)
    return 2 ** max(int(np.floor(min(np.ceil(np.log2(max(wanted, 1.0))), np.log2(max(allowed, 1.0))))), 0)
