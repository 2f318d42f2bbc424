"""Shadow casters: terrain blocks whose shadow falls on visible blocks, traced along sun rays.

Terrain shades only terrain and objects on it. So testing the visible blocks is enough; no view is tested for
the shadow of each block.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...geometry.grids import dilate
from ...run import sun
from ..shot import Shot

_LOWEST = 1.0  # degrees; lower suns cast no shadows, as in `lod.visible_mask`
_TURN = 2.0  # degrees; suns closer together are merged, as blocks are dilated on all sides


def with_shade(
    shot: Shot, centre: NDArray[np.float64], rise: NDArray[np.float64], seen: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Visible blocks (ny, nx) and the blocks that cast a shadow on one of them under any of the suns.

    Parameters
    ----------
    centre, rise
        Block centres (ny, nx, 3) in the scene, m, and half heights (ny, nx), m.
    """
    if not seen.any():
        return seen
    shading = seen.copy()
    low = -dilate(rise - centre[..., 2], 1)
    lit = dilate(seen, 1)
    for bearing, height in _suns(shot):
        rest = np.flatnonzero(~shading)
        shading.ravel()[rest] = _reaches(centre, rise, low, lit, rest, bearing, height)
    return shading


def _reaches(
    centre: NDArray, rise: NDArray, low: NDArray, lit: NDArray, rest: NDArray, bearing: float, height: float
) -> NDArray[np.bool_]:
    """Return whether each block's shadow (n,) falls on a `lit` block before it passes below the ground.

    Blocks are dilated by one block on all sides.
    """
    north, east = centre[:, centre.shape[1] // 2, 1], centre[centre.shape[0] // 2, :, 0]
    step = min(np.diff(axis).min(initial=np.inf) for axis in (north, east))
    ends = [0.5 * (axis[1:] + axis[:-1]) for axis in (north, east)]
    row, column = np.unravel_index(rest, lit.shape)
    y, x, top = north[row], east[column], (centre[..., 2] + rise).ravel()[rest]
    toward_north, toward_east = -np.cos(np.radians(bearing)), -np.sin(np.radians(bearing))
    shades, going = np.zeros(len(rest), bool), np.arange(len(rest))
    way = 0.0
    while len(going) and np.isfinite(step):  # a single block shades no other
        way += step
        row = np.searchsorted(ends[0], y[going] + way * toward_north)
        column = np.searchsorted(ends[1], x[going] + way * toward_east)
        above = top[going] - max(way - 2.0 * step, 0.0) * np.tan(np.radians(height)) >= low[row, column]
        shades[going] |= above & lit[row, column]
        inside = (row > 0) & (row < len(north) - 1) & (column > 0) & (column < len(east) - 1)
        going = going[above & inside & ~shades[going]]
    return shades


def _suns(shot: Shot) -> list[tuple[float, float]]:
    """Azimuth and elevation (degrees) of the shadow-casting lights over the filmed frames, `_TURN` apart."""
    frames = np.unique(np.concatenate([shot.filmed(path) for path in shot.paths]))
    suns: list[tuple[float, float]] = []
    for time in shot.frames.times[frames]:
        east, north, up = sun.toward_light(shot.run, float(time))
        bearing, height = np.degrees(np.arctan2(east, north)), np.degrees(np.arcsin(up))
        last = suns[-1] if suns else (np.inf, np.inf)
        if height >= _LOWEST and np.hypot(bearing - last[0], height - last[1]) >= _TURN:
            suns.append((float(bearing), float(height)))
    return suns
