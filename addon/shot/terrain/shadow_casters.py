"""Which blocks of ground throw shadows on blocks that are seen, found along the rays of the sun.

Ground shades nothing but ground and what stands on it. So it is enough to know which blocks are seen, and no
view need be asked about the shadow of each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .. import sun

if TYPE_CHECKING:
    from ..settings.protocols import ShotView

_LOWEST = 1.0  # degrees; suns lower than this throw no shadows, as in `lod.visible_mask`
_TURN = 2.0  # degrees; of suns nearer to each other than this one is asked: blocks are wider all round


def with_shade(
    shot: ShotView, centre: NDArray[np.float64], rise: NDArray[np.float64], seen: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Blocks (ny, nx) that are `seen`, and those that throw a shadow on one that is, with any of the suns.

    Parameters
    ----------
    centre, rise
        (ny, nx, 3) middles in the scene, m, and (ny, nx) how far the ground of each is above and below, m.
    """
    if not seen.any():
        return seen
    shading = seen.copy()
    low = -_widest(rise - centre[..., 2])
    lit = _widest(seen)
    for bearing, height in _suns(shot):
        rest = np.flatnonzero(~shading)
        shading.ravel()[rest] = _reaches(centre, rise, low, lit, rest, bearing, height)
    return shading


def _reaches(
    centre: NDArray, rise: NDArray, low: NDArray, lit: NDArray, rest: NDArray, bearing: float, height: float
) -> NDArray[np.bool_]:
    """Whether the shadow of each of some blocks (n,) falls on a `lit` one before it is under the ground.

    Blocks are taken to be a block wider on all sides.
    """
    north, east = centre[:, centre.shape[1] // 2, 1], centre[centre.shape[0] // 2, :, 0]
    step = min(np.diff(axis).min(initial=np.inf) for axis in (north, east))
    ends = [0.5 * (axis[1:] + axis[:-1]) for axis in (north, east)]
    row, column = np.unravel_index(rest, lit.shape)
    y, x, top = north[row], east[column], (centre[..., 2] + rise).ravel()[rest]
    toward_north, toward_east = -np.cos(np.radians(bearing)), -np.sin(np.radians(bearing))
    found, going = np.zeros(len(rest), bool), np.arange(len(rest))
    way = 0.0
    while len(going) and np.isfinite(step):  # a block alone has nothing to shade
        way += step
        row = np.searchsorted(ends[0], y[going] + way * toward_north)
        column = np.searchsorted(ends[1], x[going] + way * toward_east)
        above = top[going] - max(way - 2.0 * step, 0.0) * np.tan(np.radians(height)) >= low[row, column]
        found[going] |= above & lit[row, column]
        inside = (row > 0) & (row < len(north) - 1) & (column > 0) & (column < len(east) - 1)
        going = going[above & inside & ~found[going]]
    return found


def _suns(shot: ShotView) -> list[tuple[float, float]]:
    """Bearings and heights (degrees) of what throws shadows in what is filmed, `_TURN` apart."""
    frames = np.unique(np.concatenate([shot.filmed(path) for path in shot.paths]))
    suns: list[tuple[float, float]] = []
    for time in shot.frames.times[frames]:
        east, north, up = sun.toward_light(shot.run, float(time))
        bearing, height = np.degrees(np.arctan2(east, north)), np.degrees(np.arcsin(up))
        last = suns[-1] if suns else (np.inf, np.inf)
        if height >= _LOWEST and np.hypot(bearing - last[0], height - last[1]) >= _TURN:
            suns.append((float(bearing), float(height)))
    return suns


def _widest(field: NDArray) -> NDArray:
    """The largest of each value and its eight neighbours'."""
    padded = np.pad(field, 1, "edge")
    rows = np.maximum(np.maximum(padded[:-2], padded[1:-1]), padded[2:])
    return np.maximum(np.maximum(rows[:, :-2], rows[:, 1:-1]), rows[:, 2:])
