from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

def levels(distance: ArrayLike) -> NDArray[np.uint8]:
    """Level of each distance (m): <= 1500 -> 0, <= 3500 -> 1, else (and for NaN) 2."""

class Table:
    def __init__(
        self, thresholds: Sequence[float] = (1500.0, 3500.0), multipliers: Sequence[float] = (1.0, 0.7, 0.4)
    ) -> None: ...
    @property
    def thresholds(self) -> list[float]: ...
    @property
    def multipliers(self) -> list[float]: ...
    def levels(self, distance: ArrayLike) -> NDArray[np.uint8]: ...
    def multiplier(self, distance: ArrayLike) -> NDArray[np.float64]: ...

def select(position: ArrayLike, camera: ArrayLike, budget: int) -> NDArray[np.int64]:
    """Indices of the `budget` positions (n, 3) nearest to any camera (m, 3), nearest first, ties by index."""
