"""A grid mesh whose cells are divided more finely where wanted, without cracks.

A cell of level L is 2^L x 2^L quads. Where a cell meets a finer one, its outer quads become polygons that
hold the finer cell's points, so that both share every vertex of their border.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class GridMesh:
    """Vertices by fractional row and column (n,), and polygons as loops of vertex numbers."""

    row: NDArray[np.float64]
    column: NDArray[np.float64]
    loops: NDArray[np.int32]  # (m,) vertex of every corner
    starts: NDArray[np.int32]  # (polygons,) first corner of every polygon


def graded(level: NDArray[np.int64]) -> GridMesh:
    """Mesh of a grid with one level per cell, (rows - 1, columns - 1)."""
    finest = int(level.max(initial=0))
    stride = (level.shape[1] << finest) + 1  # points in a row of the finest lattice
    plain, mixed = _around(level)
    polygons = []
    for depth in range(finest + 1):
        cells = np.argwhere((level == depth) & plain)
        if len(cells):
            polygons.append(_quads(cells, depth, finest, stride))
    quads = np.concatenate(polygons) if polygons else np.empty((0, 4), np.int64)
    rings = [ring for cell in np.argwhere(mixed) for ring in _rings(level, cell, finest, stride)]
    corners = np.concatenate([quads.ravel(), *(np.array(ring) for ring in rings)])
    sizes = np.concatenate([np.full(len(quads), 4), [len(ring) for ring in rings]]).astype(np.int64)
    points, loops = np.unique(corners, return_inverse=True)
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    scale = 1.0 / (1 << finest)
    return GridMesh(
        (points // stride) * scale, (points % stride) * scale, loops.astype(np.int32), starts.astype(np.int32)
    )


def _neighbour(level: NDArray[np.int64], dy: int, dx: int) -> NDArray[np.int64]:
    padded = np.pad(level, 1, "edge")
    return padded[1 + dy : 1 + dy + level.shape[0], 1 + dx : 1 + dx + level.shape[1]]


def _around(level: NDArray[np.int64]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Cells without and with a finer neighbour."""
    sides = (_neighbour(level, dy, dx) for dy, dx in ((-1, 0), (0, 1), (1, 0), (0, -1)))
    mixed = np.maximum.reduce(list(sides)) > level
    return ~mixed, mixed


def _quads(cells: NDArray[np.int64], depth: int, finest: int, stride: int) -> NDArray[np.int64]:
    """Corners (n * 4^depth, 4) of the quads of plain cells, counter-clockwise seen from above."""
    size = 1 << (finest - depth)
    steps = np.arange(1 << depth) * size
    y = (cells[:, 0, None, None] << finest) + steps[:, None]
    x = (cells[:, 1, None, None] << finest) + steps[None, :]
    low = (y * stride + x).ravel()
    return np.stack([low, low + size, low + size * stride + size, low + size * stride], axis=-1)


def _rings(level: NDArray[np.int64], cell: NDArray[np.int64], finest: int, stride: int) -> list[list[int]]:
    """Polygons of a cell that has finer neighbours."""
    i, j = int(cell[0]), int(cell[1])
    depth = int(level[i, j])
    count, size = 1 << depth, 1 << (finest - depth)

    def step(di: int, dj: int) -> int:
        """Distance of points along the side towards a neighbour."""
        y, x = min(max(i + di, 0), level.shape[0] - 1), min(max(j + dj, 0), level.shape[1] - 1)
        return 1 << (finest - max(depth, int(level[y, x])))

    south, east, north, west = step(-1, 0), step(0, 1), step(1, 0), step(0, -1)
    rings = []
    for a in range(count):
        for b in range(count):
            y0, x0 = (i << finest) + a * size, (j << finest) + b * size
            y1, x1 = y0 + size, x0 + size
            ring = [y0 * stride + x for x in range(x0, x1, south if a == 0 else size)]
            ring += [y * stride + x1 for y in range(y0, y1, east if b == count - 1 else size)]
            ring += [y1 * stride + x for x in range(x1, x0, -(north if a == count - 1 else size))]
            ring += [y * stride + x0 for y in range(y1, y0, -(west if b == 0 else size))]
            rings.append(ring)
    return rings
