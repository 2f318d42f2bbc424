"""Statistics of ensembles: burned shares, arrival quantiles, and depths of members."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import Error
from .ensemble import Ensemble


@dataclass(frozen=True)
class Shares:
    """Shares of members that have burned each cell.

    Attributes
    ----------
    times
        (nt,) s since the issue time.
    share
        (nt, ny, nx) float32, 0 to 1: weight of the members that burned the cell by then / weight of those
        that simulated it; NaN where none did.
    counted
        (nt,) number of members that were simulated up to the time; others are in neither number.
    """

    times: NDArray[np.float64]
    share: NDArray[np.float32]
    counted: NDArray[np.int64]


def shares(ensemble: Ensemble, times: ArrayLike) -> Shares:
    """Compute the share of members that have burned each cell by each time (s since the issue time)."""
    moments = np.atleast_1d(np.asarray(times, np.float64))
    _, rows, columns = ensemble.shape
    counted = np.array([ensemble.counted(moment) for moment in moments])
    weights = ensemble.weights.astype(np.float32)
    share = np.empty((len(moments), rows, columns), np.float32)
    for these, arrival in ensemble.blocks():
        missing = np.isnan(arrival)
        somewhere = bool(missing.any())
        for index, moment in enumerate(moments):
            weight = np.where(counted[index], weights, np.float32(0.0))
            burned = np.tensordot(weight, arrival <= moment, 1)
            of = weight.sum() - (np.tensordot(weight, missing, 1) if somewhere else np.float32(0.0))
            with np.errstate(invalid="ignore"):
                share[index, these] = burned / of
    return Shares(moments, share, counted.sum(1))


def quantiles(ensemble: Ensemble, levels: ArrayLike) -> NDArray[np.float32]:
    """Compute quantiles of the arrival time in each cell, over all members that reach the horizon.

    A quantile is the earliest arrival by which at least this share of the weight has burned (the inverse of
    the empirical distribution; Hyndman and Fan, The American Statistician 50(4), 1996, definition 1). It is
    +inf where less than this share burns at all: "never" counts, unlike in a mean of the burned members.

    Parameters
    ----------
    levels
        (k,) shares above 0, up to 1.

    Returns
    -------
    quantiles
        (k, ny, nx) s since the issue time; NaN where no member simulated the cell.

    Raises
    ------
    Error
        No member reaches the horizon.
    """
    asked = np.atleast_1d(np.asarray(levels, np.float64))
    if not ((asked > 0.0) & (asked <= 1.0)).all():
        raise Error(f"quantiles: levels are above 0 and up to 1, not {asked}")
    counted = ensemble.counted_at_end()
    weights = ensemble.weights[counted]
    same = bool((weights == weights[0]).all())
    _, rows, columns = ensemble.shape
    result = np.empty((len(asked), rows, columns), np.float32)
    for these, arrival in ensemble.blocks():
        values = np.ascontiguousarray(arrival[counted].reshape(len(weights), -1).T)
        if same and not np.isnan(values).any():
            found = _equal(values, asked)
        else:
            found = _weighted(values, weights, asked)
        result[:, these] = found.reshape(len(asked), -1, columns)
    return result


def members_of_share(share: float, count: int) -> int:
    """Return the least number of `count` members that are at least a share of them, 1 or more."""
    return max(1, int(-(-Fraction(str(share)) * count // 1)))  # exact: 0.1 of 10 is one


def _equal(values: NDArray[np.float32], levels: NDArray[np.float64]) -> NDArray[np.float32]:
    """Compute quantiles (k, cells) of values (cells, m) of equal weight, without NaN."""
    count = values.shape[1]
    picks = [members_of_share(float(level), count) - 1 for level in levels]
    values.partition(sorted({*picks}), axis=1)
    return values[:, picks].T


def _weighted(
    values: NDArray[np.float32], weights: NDArray[np.float64], levels: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Compute quantiles (k, cells) of values (cells, m) with weights (m,); NaN has no weight."""
    order = np.argsort(values, axis=1)  # NaN comes last
    ordered = np.take_along_axis(values, order, 1)
    weight = np.where(np.isnan(ordered), 0.0, weights[order])
    upto = weight.cumsum(1)
    total = upto[:, -1]
    result = np.empty((len(levels), len(values)), np.float32)
    for index, level in enumerate(levels):
        enough = upto >= (level - 1e-12) * total[:, None]
        pick = np.take_along_axis(ordered, enough.argmax(1)[:, None], 1)[:, 0]
        result[index] = np.where(total > 0.0, pick, np.nan)
    return result


def burned_areas(ensemble: Ensemble, times: ArrayLike) -> NDArray[np.float64]:
    """Compute the burned area (m, nt) of each member at each time (s), m2; NaN after the member's end."""
    moments = np.atleast_1d(np.asarray(times, np.float64))
    area = ensemble.areas
    result = np.zeros((len(ensemble.members), len(moments)))
    for these, arrival in ensemble.blocks():
        for index, moment in enumerate(moments):
            result[:, index] += np.einsum("mrc,rc->m", arrival <= moment, area[these])
    for index, moment in enumerate(moments):
        result[~ensemble.counted(moment), index] = np.nan
    return result


def overlaps(ensemble: Ensemble, time: float) -> NDArray[np.float64]:
    """Compute the common burned area (m, m) of each pair of members at a time (s), m2."""
    count = len(ensemble.members)
    result, area = np.zeros((count, count)), ensemble.areas
    for these, arrival in ensemble.blocks():
        burned = (arrival <= time).reshape(count, -1)
        touched = burned.any(0)
        root = np.sqrt(area[these].ravel()[touched]).astype(np.float32)
        inside = burned[:, touched] * root
        result += inside @ inside.T  # of one array: BLAS computes half of the products
    return result


def depths(ensemble: Ensemble, time: float) -> NDArray[np.float64]:
    """Compute the epsilon inclusion depth (m,) of the members' burned areas at a time (s).

    The depth is the lower of two means over the other members: the share of this member's area inside theirs,
    and the share of their area inside this one (Chaves-de-Plaza et al., Inclusion Depth for Contour
    Ensembles, IEEE TVCG 30(9), 2024). The deepest member is typical. Members that end before the time have
    NaN.

    The sums over pairs of members are sums over cells: of the number of members that burned the cell, and of
    their weights 1 / area. So the time grows with the number of members, not with its square.
    """
    counted = ensemble.counted(time)
    own = burned_areas(ensemble, [time])[counted, 0]
    some = own > 0.0
    least = own[some].min(initial=1.0)
    weights = np.stack([np.ones_like(own), np.divide(least, own, out=np.zeros_like(own), where=some)])
    sums = np.zeros((2, len(own)))
    for these, arrival in ensemble.blocks():
        burned = (arrival <= time)[counted].reshape(len(own), -1)
        touched = burned.any(0)
        inside = burned[:, touched].astype(np.float64)
        sums += (weights @ inside * ensemble.areas[these].ravel()[touched]) @ inside.T
    others = len(own) - 1
    with np.errstate(invalid="ignore", divide="ignore"):
        of_this = np.where(some, sums[0] / own - 1.0, others)  # nothing is inside everything
    of_others = np.where(some, sums[1] / least - 1.0 + np.count_nonzero(~some), np.count_nonzero(~some) - 1)
    result = np.full(len(counted), np.nan)
    result[counted] = np.minimum(of_this, of_others) / max(others, 1)
    return result
