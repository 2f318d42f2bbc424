"""Block-wise reading of the fuel grid, which keeps memory use bounded."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

CELLS = 1 << 18
"""Cells of a block, about: 2 MB of float64."""


def rows(run: Run) -> Iterator[tuple[int, int]]:
    """List the row ranges of the blocks: first row, and one past the last."""
    fy, fx = len(run.fuel_latitude), len(run.fuel_longitude)
    step = max(CELLS // fx, 1)
    return ((first, min(first + step, fy)) for first in range(0, fy, step))


def arrival(run: Run, known: NDArray | None = None) -> Callable[[int, int], NDArray]:
    """Return a row reader for arrival times (s, NaN: never): from `known`, otherwise from the run."""
    if known is None and run.has("fuel_arrival_time"):
        return lambda first, last: run.fuel_rows("fuel_arrival_time", first, last)
    whole = run.fuel_arrival_time() if known is None else np.asarray(known)
    return lambda first, last: whole[first:last]
