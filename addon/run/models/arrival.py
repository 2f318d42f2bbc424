"""Arrival time from a time series of a level set function or of a burned fraction."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray


def from_levels(
    times: NDArray[np.float64], level: Callable[[int], NDArray], shape: tuple[int, ...]
) -> NDArray[np.float64]:
    """Compute arrival times (s) from a level set function, negative in burned cells; NaN: never.

    Interpolation is linear in time between two maps. For a front of constant speed it is exact, as the level
    set function is the distance to the front. A cell that ignites between a map without fire (constant
    everywhere) and the next has no distance; it takes the mean of both times, with an error of half their
    interval at most.
    """
    arrival = np.full(shape, np.nan)
    before = None
    for index, time in enumerate(times):
        now = level(index)
        inside = now < 0
        if before is None:
            arrival[inside] = time
        else:
            new = inside & np.isnan(arrival)
            a, b = before[new].astype(np.float64), now[new].astype(np.float64)
            blank = before.size > 1 and before.min() == before.max()
            part = 0.5 if blank else np.maximum(a, 0.0) / np.maximum(np.maximum(a, 0.0) - b, 1e-30)
            arrival[new] = times[index - 1] + part * (time - times[index - 1])
        before = now
    return arrival


def from_share(
    times: NDArray[np.float64], share: Callable[[int], NDArray], shape: tuple[int, ...]
) -> NDArray[np.float64]:
    """Compute arrival times (s), when half a cell has burned, from burned fractions; NaN: never."""
    return from_levels(times, lambda index: 0.5 - share(index), shape)


def held(
    arrival: NDArray, times: NDArray[np.float64], share: Callable[[int], NDArray]
) -> NDArray[np.float64]:
    """Constrain a model's own arrival times (s) by when half of each cell burned; NaN where less has.

    A valid time lies between the last map with less than half of a cell burned and the first with more. Any
    other is the time of another event, such as first contact; such cells take the time of `from_share`.
    """
    by_share = from_share(times, share, arrival.shape)
    late = np.searchsorted(times, by_share)  # beyond the last index if NaN
    early = np.concatenate([[-np.inf], times])[late]
    within = (arrival > early) & (arrival <= np.concatenate([times, [-np.inf]])[late])
    return np.where(within, arrival, by_share)
