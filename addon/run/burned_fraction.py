"""The burned fraction of fuel cells (0..1), of models that say how much of each cell has burned.

A front on a coarse grid burns cells in part: whole cells counted once the front has touched them make a young
fire far too large.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

FIELD = "burned_fraction"


def at(run: Run, time: float) -> NDArray[np.float32]:
    """(fy, fx) at a model time (s): linear between the run's times, 0 before and held after them."""
    known = np.asarray(run.times)
    after = int(np.searchsorted(known, time))
    if time < known[0]:
        return np.zeros((len(run.fuel_latitude), len(run.fuel_longitude)), np.float32)
    if after == len(known) or known[after] == time:
        return _frame(run, min(after, len(known) - 1))
    part = np.float32((time - known[after - 1]) / (known[after] - known[after - 1]))
    return (1 - part) * _frame(run, after - 1) + part * _frame(run, after)


def areas(
    run: Run, moments: Sequence[float] | NDArray[np.float64], strip: NDArray, width: NDArray
) -> list[float]:
    """Burned area (m2) by each of these model times (s), linear between the run's times.

    Parameters
    ----------
    strip, width
        Factors (fy,) and (fx,) of the cells' areas, as of `areas.area_factors`.
    """
    known = np.asarray(run.times)
    after = np.clip(np.searchsorted(known, moments), 0, len(known) - 1)
    wanted = np.unique([after, np.maximum(after - 1, 0)])
    found = [float(strip @ (_frame(run, int(index)) @ width)) for index in wanted]
    return np.interp(moments, known[wanted], found, left=0.0).tolist()


def _frame(run: Run, index: int) -> NDArray[np.float32]:
    return np.clip(np.nan_to_num(run.burned_fraction(index)), 0.0, 1.0)
