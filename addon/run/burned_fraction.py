"""Burned fraction of fuel cells (0..1), for models that report partial burning of a cell.

On a coarse grid a front burns cells in part. Counting whole cells from first contact would make a young fire
far too large.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

FIELD = "burned_fraction"


def at(run: Run, time: float) -> NDArray[np.float32]:
    """Interpolate the burned fraction (fy, fx) at a model time (s): 0 before the run, constant after it."""
    run_times = np.asarray(run.times)
    after = int(np.searchsorted(run_times, time))
    if time < run_times[0]:
        return np.zeros((len(run.fuel_latitude), len(run.fuel_longitude)), np.float32)
    if after == len(run_times) or run_times[after] == time:
        return _frame(run, min(after, len(run_times) - 1))
    part = np.float32((time - run_times[after - 1]) / (run_times[after] - run_times[after - 1]))
    return (1 - part) * _frame(run, after - 1) + part * _frame(run, after)


def areas(
    run: Run, moments: Sequence[float] | NDArray[np.float64], strip: NDArray, width: NDArray
) -> list[float]:
    """Compute the burned area (m2) at model times (s), linear between the run's times.

    Parameters
    ----------
    strip, width
        Area factors (fy,) and (fx,), as `areas.area_factors` returns them.
    """
    known = np.asarray(run.times)
    after = np.clip(np.searchsorted(known, moments), 0, len(known) - 1)
    wanted = np.unique([after, np.maximum(after - 1, 0)])
    burned = [float(strip @ (_frame(run, int(index)) @ width)) for index in wanted]
    return np.interp(moments, known[wanted], burned, left=0.0).tolist()


def _frame(run: Run, index: int) -> NDArray[np.float32]:
    return np.clip(np.nan_to_num(run.burned_fraction(index)), 0.0, 1.0)
