"""Grids of the fuel, some rows at a time: what is asked of a run need not hold all of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

CELLS = 1 << 18
"""Of a block, about: 2 MB of float64."""


def rows(run: Run) -> Iterator[tuple[int, int]]:
    """First row of each block of the fuel grid, and the first after it."""
    fy, fx = len(run.fuel_latitude), len(run.fuel_longitude)
    step = max(CELLS // fx, 1)
    return ((first, min(first + step, fy)) for first in range(0, fy, step))


def arrival(run: Run, known: NDArray | None = None) -> Callable[[int, int], NDArray]:
    """What reads some rows of arrival times (s, NaN where never): of `known`, else of the run's."""
    if known is None and run.has("fuel_arrival_time"):
        return lambda first, last: run.fuel_rows("fuel_arrival_time", first, last)
    whole = run.fuel_arrival_time() if known is None else np.asarray(known)
    return lambda first, last: whole[first:last]
