"""Scores of probabilities and ensembles, without a grid or a fire; all sums are weighted.

Sources: Hersbach, Weather and Forecasting 15, 2000 (CRPS); Ferro, QJRMS 140, 2014 (fair CRPS); Brier, Monthly
Weather Review 78, 1950; Murphy, Journal of Applied Meteorology 12, 1973 (decomposition); Roberts and Lean,
Monthly Weather Review 136, 2008 (FSS).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def crps(members: Array, observed: Array, fair: bool = False) -> Array:
    """Compute the continuous ranked probability score (n,) of members (m, n) of equal weight.

    Parameters
    ----------
    members, observed
        Finite values; times that are never reached are censored at the end of the forecast before.
    fair
        Score that a sample from a wider ensemble would have on average; NaN for one member. Else the score of
        the empirical distribution.
    """
    count = len(members)
    ordered = np.sort(members, axis=0)
    weight = 2.0 * np.arange(count) - count + 1.0
    apart = 2.0 * np.tensordot(weight, ordered, 1)  # sum of |x_i - x_j| over all pairs
    pairs = count * (count - 1) if fair else count**2
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.abs(members - observed).mean(0) - np.divide(apart, 2.0 * pairs)


@dataclass(frozen=True)
class Brier:
    """Brier score and its parts: score = reliability - resolution + uncertainty.

    Each probability that occurs has a bin, so the sum is exact.
    """

    score: float
    reliability: float
    resolution: float
    uncertainty: float


@dataclass(frozen=True)
class ReliabilityBin:
    """One forecast probability: its value, observed frequency, number of cells, and weight (m2)."""

    probability: float
    frequency: float
    cells: int
    weight: float


def reliability(probability: Array, observed: NDArray[np.bool_], weight: Array) -> list[ReliabilityBin]:
    """Compute the observed frequency for each forecast probability (k of N)."""
    values, place = np.unique(probability, return_inverse=True)
    total = np.bincount(place, weight, len(values))
    burned = np.bincount(place, weight * observed, len(values))
    cells = np.bincount(place, minlength=len(values))
    return [
        ReliabilityBin(float(values[i]), float(burned[i] / total[i]), int(cells[i]), float(total[i]))
        for i in range(len(values))
        if total[i] > 0.0
    ]


def brier(probability: Array, observed: NDArray[np.bool_], weight: Array) -> Brier:
    """Compute the Brier score of probabilities (n,) and its parts; not the fair form."""
    total = float(weight.sum())
    base = float((weight * observed).sum() / total)
    rows = reliability(probability, observed, weight)
    return Brier(
        score=float((weight * (probability - observed) ** 2).sum() / total),
        reliability=sum(row.weight * (row.probability - row.frequency) ** 2 for row in rows) / total,
        resolution=sum(row.weight * (row.frequency - base) ** 2 for row in rows) / total,
        uncertainty=base * (1.0 - base),
    )


def fss(probability: Array, observed: Array, width: int) -> float:
    """Compute the fractions skill score of fields (ny, nx) in square windows of `width` cells inside them.

    1 is perfect; 0 means no common area. NaN if nothing is forecast or observed, or the window does not fit.
    """
    if min(probability.shape) < width:
        return float("nan")
    here, there = _window_mean(probability, width), _window_mean(observed, width)
    worst = float((here**2).sum() + (there**2).sum())
    return 1.0 - float(((here - there) ** 2).sum()) / worst if worst > 0.0 else float("nan")


def rank(members: Array, observed: float) -> tuple[int, int]:
    """Count members below the observed value, and those at or below it: the rank, and the last tied one."""
    return int((members < observed).sum()), int((members <= observed).sum())


def _window_mean(values: Array, width: int) -> Array:
    """Compute means over all windows of `width` x `width` cells."""
    total = np.pad(np.asarray(values, np.float64), ((1, 0), (1, 0))).cumsum(0).cumsum(1)
    area = total[width:, width:] - total[:-width, width:] - total[width:, :-width] + total[:-width, :-width]
    return area / width**2
