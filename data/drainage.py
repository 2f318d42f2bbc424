"""Valleys in balance with their streams: every cell drains to a river, steeply near divides.

The stream-power law says that in balance a stream's slope is S = ks A^-theta, with A the area that drains
through it (Flint 1974; Whipple & Tucker 1999, doi 10.1029/1999JB900120). Given S everywhere, the height of a
cell is its river's height plus the integral of S along the way down, and the way down is the one that makes
it lowest: a shortest-path problem. Heights give new ways, ways give new areas, areas give new slopes; a few
rounds settle it (the idea of Tzathas et al. 2024, doi 10.1111/cgf.15033, solved here by Dijkstra's method).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

_STEPS = ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))


class Drainage:
    """Routes on a grid whose rivers and lakes have given heights.

    Parameters
    ----------
    fixed
        (ny, nx) heights in metres of river and lake cells, NaN elsewhere.
    cell_size
        Metres.
    """

    def __init__(self, fixed: NDArray[np.float64], cell_size: float) -> None:
        self.shape = fixed.shape
        self.cell_size = cell_size
        self.fixed = fixed.ravel()
        self.is_fixed = np.isfinite(self.fixed)
        self.lowest = np.nanmin(fixed) - 1.0
        self._edges()

    def _edges(self) -> None:
        """Directed edges between the 8 neighbours, plus one source with an edge to every fixed cell."""
        ny, nx = self.shape
        index = np.arange(ny * nx).reshape(ny, nx)
        start, end, length = [], [], []
        for dy, dx in _STEPS:
            a = index[max(0, -dy) : ny - max(0, dy), max(0, -dx) : nx - max(0, dx)].ravel()
            b = index[max(0, dy) : ny - max(0, -dy), max(0, dx) : nx - max(0, -dx)].ravel()
            keep = ~self.is_fixed[b]
            start.append(a[keep])
            end.append(b[keep])
            length.append(np.full(keep.sum(), self.cell_size * np.hypot(dy, dx)))
        river = np.flatnonzero(self.is_fixed)
        self.source = ny * nx
        start.append(np.full(river.size, self.source))
        end.append(river)
        length.append(np.zeros(river.size))
        start, end, length = (np.concatenate(parts) for parts in (start, end, length))
        order = np.lexsort((end, start))
        self.end, self.length = end[order], length[order]
        self.row_starts = np.searchsorted(start[order], np.arange(self.source + 2))
        self.rise = np.where(self.is_fixed, self.fixed - self.lowest, 0.0)

    def heights(self, slope: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Heights (ny, nx) and the cell that each cell (flat index) drains to, itself for fixed cells."""
        weight = slope.ravel()[self.end] * self.length + self.rise[self.end]
        size = self.source + 1
        graph = csr_matrix((weight, self.end, self.row_starts), shape=(size, size))
        height, parent = dijkstra(graph, indices=self.source, return_predecessors=True)
        parent = parent[:-1].astype(np.int64)
        parent[self.is_fixed] = np.flatnonzero(self.is_fixed)
        return (height[:-1] + self.lowest).reshape(self.shape), parent

    def area(self, parent: NDArray[np.int64]) -> NDArray[np.float64]:
        """Area in m2 (ny, nx) that drains through each cell on its way to a fixed cell, itself included."""
        depth = (parent != np.arange(parent.size)).astype(np.int32)
        jump = parent.copy()
        while True:  # pointer doubling: depth counts the steps down to the river
            further = depth[jump]
            if not further.any():
                break
            depth += further
            jump = jump[jump]
        order = np.argsort(depth, kind="stable")
        starts = np.searchsorted(depth[order], np.arange(depth.max() + 2))
        total = np.full(parent.size, self.cell_size**2)
        for level in range(depth.max(), 0, -1):
            cells = order[starts[level] : starts[level + 1]]
            np.add.at(total, parent[cells], total[cells])
        return total.reshape(self.shape)

    def settle(
        self, slope_of: Callable[[NDArray, NDArray], NDArray], first_area: NDArray, rounds: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Heights and areas after `rounds` of heights -> areas -> slopes; slope_of(area, height) -> slope."""
        area = first_area
        height, parent = self.heights(slope_of(area, np.full(self.shape, np.inf)))
        for _ in range(rounds):
            area = np.sqrt(
                area * self.area(parent)
            )  # halfway in the logarithm: keeps streams from flickering
            height, parent = self.heights(slope_of(area, height))
        return height, area
