"""Grid of the live smoke: slabs across each axis, finer near the viewers' target, and their light.

Each axis has slabs that are normal to it, cut into cells. A cell has the optical depth of the smoke along the
axis, and the light in its middle. A ray that makes the angle t with an axis meets 1 / cos t of a slab's
optical depth. Weighted by cos^4 t over the sum of all axes, the slabs together have the ray's depth from
every direction, and those seen from their side are clear.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from firetwin_core import volume
from numpy.typing import NDArray

from ...shot.shot import Shot
from ...smoke import snapshots, sources
from ...smoke.sources import Source

_SEEN = 2.0e-8  # kg/m3, density from which smoke counts for the extent
_NEAR = (700.0, 700.0, 200.0)  # m, distance from the target at which cells are twice as large as there
SLABS, CELLS = (18, 18, 12), (128, 128, 48)
"""Number of slabs along each axis, and of cells along each axis within slabs."""
_STEP = 1.0  # voxels
_REACH = 8  # cells from smoke within which clear cells take its light
_NEARBY = 0.05  # weight of neighbours in the light of a cell
_VOXEL = 50.0  # m

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SmokeGrid:
    """Edges of slabs and of cells along each axis, m."""

    slabs: tuple[Array, Array, Array]
    cells: tuple[Array, Array, Array]


@dataclass(frozen=True)
class Slabs:
    """Smoke of one axis at one time: light (slabs, rows, columns, 3), and opacity (slabs, rows, columns)."""

    light: NDArray[np.float32]
    opacity: NDArray[np.float32]


def source(shot: Shot) -> Source:
    """Return the source of the shot's smoke from all directions, on coarse voxels."""
    smoke = shot.settings.smoke
    voxel = max(shot.scale.length(_VOXEL), smoke.voxel_size)
    complete = replace(smoke, complete=True, voxel_size=voxel)
    return sources.select(shot.with_settings(replace(shot.settings, smoke=complete)))


def make(source: Source, frames: list[int], target: Array) -> SmokeGrid | None:
    """Return the grid around the smoke of these frames; None without smoke."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for domain in source.domains:
        heights = domain.heights()
        for frame in frames:
            (west, south), smoke = snapshots.load_smoke(domain.snapshot_path(source.snapshot(frame)))
            k, j, i = np.nonzero(smoke > _SEEN)
            if not len(k):
                continue
            corner, size = domain.box.corner, domain.box.spacing
            z = heights[k, j + south, i + west]
            for axis, at in enumerate((corner[0] + (i + west) * size, corner[1] + (j + south) * size, z)):
                low[axis] = min(low[axis], at.min() - size)
                high[axis] = max(high[axis], at.max() + 2.0 * size)
    if not np.isfinite(low).all():
        return None
    low[2] = max(low[2], min(float(domain.ground.min()) for domain in source.domains) - 10.0)

    def edges(axis: int, count: int) -> Array:
        """Edges whose spacing grows with the distance from the target."""
        x = np.linspace(low[axis], high[axis], 4001)
        density = 1.0 / (1.0 + np.abs(x - np.clip(target[axis], low[axis], high[axis])) / _NEAR[axis])
        share = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
        return np.interp(np.linspace(0.0, share[-1], count + 1), share, x)

    slabs, cells = ([edges(axis, count[axis]) for axis in range(3)] for count in (SLABS, CELLS))
    return SmokeGrid((slabs[0], slabs[1], slabs[2]), (cells[0], cells[1], cells[2]))


def plane(axis: int) -> tuple[int, int]:
    """Return the axes of rows and columns of slabs normal to an axis."""
    return (2, 1) if axis == 0 else (2, 0) if axis == 1 else (1, 0)


def bake(grid: SmokeGrid, layers: list[volume.Bricks], light: volume.Illumination) -> list[Slabs]:
    """March through the slabs of each axis, a ray in each cell, and through each cell for its light."""
    seen = _march(grid, 2, grid.cells[2], layers, light)
    field = _filled(seen.transpose(2, 1, 0, 3))
    made = []
    for axis in range(3):
        opacity = _march(grid, axis, grid.slabs[axis], layers, light)[..., 3]
        _clear_rim(opacity)
        made.append(Slabs(on_sheets(grid, axis, field), opacity))
    return made


def _march(
    grid: SmokeGrid, axis: int, edges: Array, layers: list[volume.Bricks], light: volume.Illumination
) -> NDArray[np.float32]:
    """Return light and opacity (slabs, rows, columns, 4) between edges along an axis."""
    rows, columns = (_middle(grid.cells[k]) for k in plane(axis))
    shape = len(edges) - 1, len(rows), len(columns)
    origins = np.empty((*shape, 3))
    origins[..., plane(axis)[0]] = rows[:, None]
    origins[..., plane(axis)[1]] = columns
    origins[..., axis] = edges[:-1, None, None]
    ends = np.broadcast_to(np.diff(edges)[:, None, None], shape).reshape(-1, 1)
    way = np.broadcast_to(np.eye(3)[axis], (ends.size, 3))
    found = volume.march(layers, origins.reshape(-1, 3), np.ascontiguousarray(way), ends, light, _STEP)
    found = np.array(found, np.float32).reshape(*shape, 4)
    found[..., 3] = 1.0 - found[..., 3]
    return found


def _middle(edges: Array) -> Array:
    return 0.5 * (edges[1:] + edges[:-1])


def _filled(seen: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the light (x, y, z, 3) of opaque smoke in each cell; clear cells take the light nearby."""
    total = seen.copy()
    mean = seen.sum(axis=(0, 1, 2))
    for _ in range(_REACH):
        near = total
        for axis in range(3):
            padded = np.pad(near, [(int(k == axis),) * 2 for k in range(4)])
            near = (
                padded.take(range(near.shape[axis]), axis)
                + near
                + padded.take(range(2, near.shape[axis] + 2), axis)
            ) / np.float32(3.0)
        total = seen + np.float32(_NEARBY) * near
    total += np.float32(1.0e-9) * mean / max(float(mean[3]), 1.0e-9)
    return total[..., :3] / np.maximum(total[..., 3:], np.float32(1.0e-12))


def on_sheets(grid: SmokeGrid, axis: int, field: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the light (slabs, rows, columns, 3) of the cells (x, y, z, 3) on the sheets of an axis.

    Light depends on the place alone: sheets that cross are equally bright there, so their order is not seen.
    """
    first, second = plane(axis)
    field = field.transpose(axis, first, second, 3)
    at = np.interp(_middle(grid.slabs[axis]), _middle(grid.cells[axis]), np.arange(len(field)))
    low = np.minimum(at.astype(int), len(field) - 2)
    part = (at - low).astype(np.float32)[:, None, None, None]
    return (1.0 - part) * field[low] + part * field[low + 1]


def _clear_rim(opacity: NDArray[np.floating]) -> None:
    """Clear the cells at the sides, so that neighbours in a picture do not run into each other."""
    for side in (0, -1):
        opacity[:, side] = opacity[:, :, side] = 0.0
