"""Rate of spread from arrival times: the upwind gradient, which a front obeys on a grid.

A level set or fast marching method computes the time of a cell from the earlier neighbour along each axis
(Rouy and Tourin 1992, SIAM J. Numer. Anal. 29, 867-884). The same differences return the speed exactly,
however uneven it is. Noise makes the larger of two differences too large, so `of_noisy_arrival` takes central
differences of smoothed times. They are too small where fronts meet or begin, and have no value there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_LATE = 6.0  # a cell this many times later than the spread of its neighbours' times is late (chosen by trial)
_STOP = 20.0  # an upwind difference this many times the smaller one is a stop, not a slow front (by trial)
_CLIP = 6.0  # errors of a time by which a pair of neighbours may differ from a straight front (by trial)
_BEND = 0.4  # second difference over the mean gradient around it at which fronts meet or begin (by trial)
_NOISE_LEFT = 0.0130  # variance of a central difference of `smoothed` white noise of variance 1
_MOST_NOISE = 0.9  # largest share of a squared gradient that counts as noise


def of_arrival(arrival: NDArray[np.float64], cell: tuple[float, float]) -> NDArray[np.float64]:
    """Compute the rate of spread (m/s) in cells (width, height) in m: inverse gradient of arrival time (s).

    Along each axis the difference to the earlier neighbour counts. If it is `_STOP` times the other
    difference, the front stopped before the cell or came from elsewhere, and the other one counts. A single
    late cell has the time of its neighbours. Infinite for cells without an earlier neighbour.
    """
    padded = np.pad(without_late_cells(arrival), 1, constant_values=np.nan)
    here, inner = padded[1:-1, 1:-1], np.s_[1:-1]
    rows = _upwind(here, padded[:-2, inner], padded[2:, inner]) / cell[1]
    columns = _upwind(here, padded[inner, :-2], padded[inner, 2:]) / cell[0]
    with np.errstate(divide="ignore"):
        return 1.0 / np.hypot(rows, columns)


def of_noisy_arrival(arrival: NDArray[np.float64], cell: tuple[float, float]) -> NDArray[np.float64]:
    """Compute the rate of spread (m/s) from noisy times; NaN where fronts meet, begin or end.

    Next to such cells a gradient below the mean around it is a part of the bend, and has no value either.
    The square of a gradient contains the variance of its noise, which is subtracted, up to `_MOST_NOISE`.
    """
    times = without_late_cells(arrival)
    noise = _noise(times)
    padded = np.pad(smoothed(times, _CLIP * noise), 1, constant_values=np.nan)
    here, inner = padded[1:-1, 1:-1], np.s_[1:-1]
    square, bend, error = np.zeros(here.shape), np.zeros(here.shape), 0.0
    for before, after, side in (
        (padded[:-2, inner], padded[2:, inner], cell[1]),
        (padded[inner, :-2], padded[inner, 2:], cell[0]),
    ):
        square += (0.5 * (after - before) / side) ** 2
        error += _NOISE_LEFT * (noise / side) ** 2
        bend = np.maximum(bend, np.abs(before + after - 2.0 * here) / side)
    gradient = np.sqrt(square - np.minimum(error, _MOST_NOISE * square))
    gradient = np.where(bend < _BEND * mean_around(gradient, 2), gradient, np.nan)
    bent = np.pad(np.isnan(gradient) & np.isfinite(arrival), 1)
    beside = bent[:-2, inner] | bent[2:, inner] | bent[inner, :-2] | bent[inner, 2:]
    with np.errstate(divide="ignore"):
        return np.where(beside & (gradient < mean_around(gradient, 2)), np.nan, 1.0 / gradient)


def mean_around(values: NDArray[np.float64], reach: int) -> NDArray[np.float64]:
    """Average the finite values of the square of cells up to `reach` away; NaN without any."""
    rows, columns = values.shape
    padded = np.pad(values, reach, constant_values=np.nan)
    total, count = np.zeros(values.shape), np.zeros(values.shape)
    for row in range(2 * reach + 1):
        for column in range(2 * reach + 1):
            each = padded[row : row + rows, column : column + columns]
            finite = np.isfinite(each)
            total, count = total + np.where(finite, each, 0.0), count + finite
    return np.divide(total, count, out=np.full(values.shape, np.nan), where=count > 0)


def _noise(arrival: NDArray[np.float64]) -> float:
    """Estimate the standard deviation of the times' errors (s) from second differences; 0 without any."""
    steps = np.concatenate([np.abs(np.diff(arrival, 2, axis=axis)).ravel() for axis in (0, 1)])
    steps = steps[np.isfinite(steps)]
    return float(np.median(steps)) / (0.6745 * np.sqrt(6.0)) if len(steps) else 0.0


def without_late_cells(arrival: NDArray[np.float64]) -> NDArray[np.float64]:
    """Replace the time (s, NaN: unburned) of single late cells by the median of their neighbours.

    A cell is late if the front went on around it: it is later than at least three of the four next cells, by
    more than `_LATE` times the median deviation of the eight neighbours' times from their median.
    """
    padded = np.pad(arrival, 1, constant_values=np.nan)
    inner = np.s_[1:-1]
    beside = (padded[:-2, inner], padded[2:, inner], padded[inner, :-2], padded[inner, 2:])
    row, column = np.nonzero(sum((arrival > each).astype(np.int8) for each in beside) >= 3)
    ring = [(up, right) for up in range(3) for right in range(3) if (up, right) != (1, 1)]
    around = np.array([padded[row + up, column + right] for up, right in ring])
    result = arrival.copy()
    if len(row):
        middle = np.nanmedian(around, axis=0)
        late = arrival[row, column] - middle > _LATE * np.nanmedian(np.abs(around - middle), axis=0)
        result[row[late], column[late]] = middle[late]
    return result


def smoothed(arrival: NDArray[np.float64], bend: float = np.inf) -> NDArray[np.float64]:
    """Average the time (s, NaN: unburned) of each cell with its neighbours, twice.

    Only pairs of opposite neighbours that both burn count, so the times of a straight front do not change.
    Pairs whose sum differs by more than `bend` (s) from twice the time are on other fronts, and do not count.
    """
    rows, columns = arrival.shape
    for _ in range(2):
        padded = np.pad(arrival, 1, constant_values=np.nan)
        total, count = arrival.copy(), np.ones(arrival.shape)
        for up, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
            pair = sum(
                padded[1 + i : 1 + i + rows, 1 + j : 1 + j + columns] for i, j in ((up, right), (-up, -right))
            )
            known = np.abs(pair - 2.0 * arrival) < bend
            total, count = total + np.where(known, pair, 0.0), count + 2.0 * known
        arrival = total / count
    return arrival


def _upwind(here: NDArray, before: NDArray, after: NDArray) -> NDArray[np.float64]:
    """Return the difference to the earlier neighbour along an axis, s; 0 without one."""
    upwind = np.nan_to_num(np.maximum(here - np.fmin(before, after), 0.0))
    least = np.nan_to_num(np.fmin(np.abs(here - before), np.abs(here - after)))
    return np.where(upwind > _STOP * least, least, upwind)
