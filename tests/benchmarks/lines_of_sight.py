"""Where what a camera sees in a volume goes in its picture, as a wind carries it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from firetwin.smoke.domains import Domain
from numpy.typing import NDArray

STEP, FARTHEST = 20.0, 12_000.0  # m along a line of sight

Array = NDArray[np.float64]


class View(Protocol):
    """A camera that stands still: `firetwin.shot.cameras.path.Path`, whose first frame counts."""

    position: Array
    rotation: Array
    half: tuple[float, float]


class Winds(Protocol):
    """Wind at places."""

    def at(self, place: Array) -> NDArray:
        """(n, 3) m/s at places (n, 3); not a number where it is unknown."""


@dataclass(frozen=True)
class Grid:
    """Values (nx, ny, nz, ...) in cells of `step` m from the middle of the first; 0 outside."""

    values: NDArray[np.float32]
    low: Array
    step: float

    def at(self, place: Array) -> NDArray[np.float32]:
        """Of the cells that places (..., 3) are in."""
        index = np.round((place - self.low) / self.step).astype(np.int64)
        shape = np.array(self.values.shape[:3])
        inside = np.all((index >= 0) & (index < shape), axis=-1)
        found = self.values[tuple(np.moveaxis(np.clip(index, 0, shape - 1), -1, 0))]
        return np.where(inside.reshape(inside.shape + (1,) * (found.ndim - inside.ndim)), found, 0)


@dataclass(frozen=True)
class SolvedWind:
    """The wind (nz, rows, columns, 3) in the cells of a `firetwin.smoke.domains.Domain`, m/s."""

    part: Domain
    wind: NDArray[np.float32]

    def at(self, place: Array) -> NDArray[np.float32]:
        """(n, 3) m/s of the cells that places (n, 3) are in; not a number outside."""
        box, (levels, rows, columns) = self.part.box, self.wind.shape[:3]
        i, j = (np.floor((place[:, a] - box.corner[a]) / box.spacing).astype(np.int64) for a in (0, 1))
        inside = (i >= 0) & (j >= 0) & (i < columns) & (j < rows)
        i, j = np.clip(i, 0, columns - 1), np.clip(j, 0, rows - 1)
        ground = self.part.ground[j, i] - self.part.mean
        # Domain.heights turned round: height = mean + above + ground (1 - above / top)
        above = (place[:, 2] - self.part.mean - ground) / (1.0 - ground / self.part.top)
        k = np.clip(np.searchsorted(box.levels, above) - 1, 0, levels - 1)
        return np.where(inside[:, None], self.wind[k, j, i], np.nan)


def rays(view: View, pixels: Array, resolution: tuple[int, int]) -> Array:
    """Unit directions (n, 3) of pixels (n, 2), column and row from the upper left."""
    share = (pixels + 0.5) / np.array(resolution) * 2.0 - 1.0
    local = np.stack([share[:, 0] * view.half[0], -share[:, 1] * view.half[1], -np.ones(len(pixels))], 1)
    found = local @ view.rotation[0].T
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def projected(view: View, place: Array, resolution: tuple[int, int]) -> Array:
    """Pixels (..., 2) of places (..., 3)."""
    local = (place - view.position[0]) @ view.rotation[0]
    share = local[..., :2] / -local[..., 2:] / np.array(view.half) * np.array([1.0, -1.0])
    return (share + 1.0) * 0.5 * np.array(resolution) - 0.5


def expected(
    view: View, grids: list[Grid], winds: Winds, pixels: Array, resolution: tuple[int, int], time: float
) -> tuple[Array, Array]:
    """Way (n, 2) px that smoke in pixels (n, 2) goes in `time` s, and the light (n,) that it stops there."""
    direction = rays(view, pixels, resolution)
    through, way, weight = np.ones(len(pixels)), np.zeros((len(pixels), 2)), np.zeros(len(pixels))
    for distance in np.arange(100.0, FARTHEST, STEP):
        place = view.position[0] + distance * direction
        extinction = sum(grid.at(place).astype(float) for grid in grids)
        stopped = through * -np.expm1(-extinction * STEP)
        through = through - stopped
        seen = stopped > 1e-4
        if np.any(seen):
            wind = winds.at(place[seen]).astype(float)
            moved = projected(view, place[seen] + time * wind, resolution) - pixels[seen]
            known = np.isfinite(moved[:, 0])
            at = np.flatnonzero(seen)[known]
            way[at] += stopped[at, None] * moved[known]
            weight[at] += stopped[at]
    return way / np.maximum(weight, 1e-9)[:, None], weight
