"""Time of arrival from a series that changes where the fire comes: a level function, or a burned share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray


def from_levels(
    times: NDArray[np.float64], level: Callable[[int], NDArray], shape: tuple[int, ...]
) -> NDArray[np.float64]:
    """Time (s) at which a level function falls below 0, NaN where never.

    Linear in time between two of its maps: a front of even speed is exact, as the level function is its
    distance. A cell lit between a map without any fire (the same value everywhere) and the next has no
    distance: the middle of the two times, off by half their interval at most.
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
    """Time (s) at which half of a cell is burned, linear between two maps; NaN where never."""
    return from_levels(times, lambda index: 0.5 - share(index), shape)


def held(
    arrival: NDArray, times: NDArray[np.float64], share: Callable[[int], NDArray]
) -> NDArray[np.float64]:
    """A model's own times of arrival (s), held to when half of each cell burned; NaN where less has.

    A time that is not between the last map with less than half of a cell burned and the first with more is
    that of something else, of the first touch for instance: such cells have the time of `from_share`.
    """
    by_share = from_share(times, share, arrival.shape)
    late = np.searchsorted(times, by_share)  # beyond the last where there is none
    early = np.concatenate([[-np.inf], times])[late]
    within = (arrival > early) & (arrival <= np.concatenate([times, [-np.inf]])[late])
    return np.where(within, arrival, by_share)
