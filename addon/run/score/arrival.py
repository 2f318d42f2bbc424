"""Arrival time error (s) of a run: positive where the run is late."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .grid import ScoreGrid


def between(run: NDArray[np.float64], seen: NDArray[np.float64], common: Sequence[float]) -> dict[str, Any]:
    """Compare two arrival times (ny, nx) in cells that burned after the first common time in both.

    Cells that burned in only one of them by the last common time are counted separately and excluded from
    means. So a run that spreads too slowly has a smaller error than its fire will have later: if its front
    needs a s/m and the other b s/m, the error of a cell at the distance x is (a - b) x.
    """
    first, last = common
    here, there = run <= last, seen <= last
    after = ~((run <= first) | (seen <= first))
    both = here & there & after
    counts = {"run_only": int((here & ~there & after).sum()), "seen_only": int((there & ~here & after).sum())}
    return _statistics(run[both] - seen[both]) | counts | {"observed": "arrival times of the other run"}


def within(
    run: NDArray[np.float64], masks: Sequence[NDArray[np.bool_]], moments: Sequence[float]
) -> dict[str, Any]:
    """Compare with perimeters: a cell in one but not in earlier ones burned between their times (s).

    The time in between is unknown. So the error is 0 if the run's arrival lies in that interval, else the
    distance to its nearer end. Cells of the first perimeter have no earlier bound and are excluded.
    """
    errors, run_never = [], 0
    seen = masks[0].copy()
    for mask, early, late in zip(masks[1:], moments[:-1], moments[1:], strict=True):
        new = mask & ~seen
        seen |= mask
        time = run[new]
        run_never += int(np.isnan(time).sum())
        time = time[~np.isnan(time)]
        errors.append(np.where(time < early, time - early, np.maximum(time - late, 0.0)))
    return (
        _statistics(np.concatenate(errors) if errors else np.empty(0))
        | {"run_only": int((~np.isnan(run) & ~seen & (run <= moments[-1])).sum()), "seen_only": run_never}
        | {"observed": "between the moments of two perimeters; 0 where the run falls there too"}
    )


def _statistics(error: NDArray[np.float64]) -> dict[str, Any]:
    if error.size == 0:
        return {"cells": 0, "bias": None, "mae": None, "rmse": None}
    return {
        "cells": int(error.size),
        "bias": float(error.mean()),
        "mae": float(np.abs(error).mean()),
        "rmse": float(np.sqrt((error**2).mean())),
    }


def sampled(there: ScoreGrid, here: ScoreGrid) -> NDArray[np.float64]:
    """Resample arrival times (s) of one grid to the cells of another by nearest neighbour; NaN outside."""
    row, column = there.cells_at(here.latitude, here.longitude)
    times = there.arrival[np.ix_(np.maximum(row, 0), np.maximum(column, 0))]
    times[row < 0, :] = np.nan
    times[:, column < 0] = np.nan
    return times
