"""What a shot can see: distance levels, budgets, views and stable slots."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .geo import HeightField

def levels(distance: ArrayLike) -> NDArray[np.uint8]:
    """Level of each distance (m): <= 1500 -> 0, <= 3500 -> 1, else (and for NaN) 2."""

class Table:
    """Levels of detail by distance: up to each of the thresholds (m) one level, and beyond them one more."""

    def __init__(
        self, thresholds: Sequence[float] = (1500.0, 3500.0), multipliers: Sequence[float] = (1.0, 0.7, 0.4)
    ) -> None: ...
    @property
    def thresholds(self) -> list[float]:
        """m, ascending."""
    @property
    def multipliers(self) -> list[float]:
        """Of particles, for each level: one more than thresholds."""
    def levels(self, distance: ArrayLike) -> NDArray[np.uint8]:
        """Level of each distance (m), of the same shape; NaN has the last."""
    def multiplier(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Particle multiplier of each distance (m), of the same shape."""

def select(position: ArrayLike, camera: ArrayLike, budget: int) -> NDArray[np.int64]:
    """Indices of the `budget` positions (n, 3) nearest to any camera (m, 3), nearest first, ties by index."""

def seen(
    position: ArrayLike,
    radius: ArrayLike,
    camera: ArrayLike,
    rotation: ArrayLike,
    fov: ArrayLike,
    near: float = 0.1,
    far: float = float("inf"),
    margin: float = 1.0,
    ground: HeightField | None = None,
) -> NDArray[np.int32]:
    """(n, 2) first and last view of a camera path that may see each ball; -1, -1 where none does.

    Balls at position (n, 3) of radius (n,) m, all made larger by `margin` m. The path has m views from camera
    (m, 3) m, with rotation (m, 3, 3) or (3, 3) to world axes (the camera looks along its -z, y is up) and whole
    angles of view fov (m, 2) or (2,) radians, across and from top to bottom. `ground` hides what lies behind it.

    No ball that a view sees is left out; some that hide just behind an edge are kept. A view with NaN sees
    nothing, a ball with NaN is never seen, and a camera in the ground sees through it.
    """

class Pool:
    """Slots for what is shown: a cell keeps its slot while it is among those asked for, so nothing pops."""

    def __init__(self, capacity: int, seed: int = 0) -> None: ...
    @property
    def capacity(self) -> int:
        """How many slots there are."""
    @property
    def cells(self) -> NDArray[np.int64]:
        """(capacity,) the cell in each slot, -1 where it is free."""
    def assign(self, cell: ArrayLike) -> NDArray[np.int32]:
        """Cells (n,), the most important first -> slots (n,), -1 for those beyond the capacity.

        Cells that have a slot keep it; new ones take the lowest free slots in their order.
        """
    def seeds(self, cell: ArrayLike) -> NDArray[np.uint32]:
        """A number for each cell that depends on the pool's seed and the cell alone."""
