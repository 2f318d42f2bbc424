"""Minimum knapsack cover: the cheapest set of resources that delivers enough, solved exactly.

Costs and deliveries are integers (cents and kg/h). States are pairs of cost and delivery; a state that
another one dominates (no higher cost, no lower delivery) is dropped (Nemhauser and Ullmann, Discrete dynamic
programming and capital allocation, Management Science 15, 1969). A state is also dropped if its cost plus the
linear relaxation of its missing delivery exceeds the cost of a known set.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Whole = NDArray[np.int64]

_MOST = 4e18  # largest sum of prices in 64 bits


class _States(NamedTuple):
    """Sets of items, by ascending cost and delivery; `before` is an index of a state of the previous step."""

    cost: Whole
    gain: Whole
    before: Whole
    taken: NDArray[np.bool_]


def cheapest(cost: Whole, gain: Whole, need: int) -> Whole | None:
    """Return the indices (k,), ascending, of the cheapest set of items whose gains sum to `need` or more.

    Ties go to the set with fewer items. Items of equal cost and gain are taken in their order. None if all
    items together are not enough.

    Parameters
    ----------
    cost, gain
        (n,) not negative.
    """
    if need <= 0:
        return np.empty(0, np.int64)
    items = np.flatnonzero(gain > 0)
    gains = np.minimum(gain[items], need)
    if int(gains.sum()) < need:
        return None
    factor = len(items) + 1  # ties go to the set with fewer items
    if float(cost[items].sum()) * factor > _MOST:
        return _solve_scaled(items, cost[items], gains, need)
    return _solve_scaled(items, cost[items] * factor + 1, gains, need)


def _solve_scaled(items: Whole, prices: Whole, gains: Whole, need: int) -> Whole:
    kept, bound = _reduce(prices, gains, need)
    chosen = _solve(prices[kept], gains[kept], need, bound)
    return np.sort(items[kept[chosen]])


def _reduce(prices: Whole, gains: Whole, need: int) -> tuple[Whole, int]:
    """Return the items that can be in a cheapest set, by ascending price per gain, and a price bound."""
    order = np.lexsort((np.arange(len(prices)), -gains, prices / gains))
    order = order[_first_equal(prices[order], gains[order], need)]
    p, g = prices[order], gains[order]
    last = int(np.searchsorted(np.cumsum(g), need))
    bound = _greedy(p, g, need, last)
    rate = p[last] / g[last]  # price of a unit in the linear relaxation
    relaxed = float(np.sum(p[:last])) + rate * float(need - np.sum(g[:last]))
    outside = np.arange(len(p)) >= last
    extra = np.where(outside, p - rate * g, 0.0)  # reduced cost: taking such an item costs this more at least
    return order[relaxed + extra <= bound * (1.0 + 1e-12) + 1e-6], bound


def _first_equal(prices: Whole, gains: Whole, need: int) -> NDArray[np.bool_]:
    """Mask equal items, which are adjacent, beyond the number that is enough without other items."""
    new = np.concatenate([[True], (np.diff(prices) != 0) | (np.diff(gains) != 0)])
    starts = np.flatnonzero(new)
    rank = np.arange(len(prices)) - starts[np.cumsum(new) - 1]
    return rank < -(-need // gains)


def _greedy(prices: Whole, gains: Whole, need: int, last: int) -> int:
    """Return the price of the items before `last` and of the cheapest item that completes the set."""
    missing = need - int(np.sum(gains[:last]))
    rest = prices[last:][gains[last:] >= missing]
    return int(np.sum(prices[:last])) + int(rest.min())


def _solve(prices: Whole, gains: Whole, need: int, bound: int) -> Whole:
    """Return the indices of the cheapest set of items sorted by price per gain; `bound` is attainable."""
    zero = np.zeros(1, np.int64)
    steps = [_States(zero, zero, zero, np.zeros(1, np.bool_))]
    sums, spent = (np.concatenate([zero, np.cumsum(each)]) for each in (gains, prices))
    limit, best = bound + 1, zero[:0]
    for item, (price, gain) in enumerate(zip(prices, gains, strict=True)):
        states = _extend(steps[-1], int(price), int(gain), need)
        for enough in np.flatnonzero(states.gain >= need):  # at most one, as the others cost more
            if states.cost[enough] < limit:
                limit = int(states.cost[enough])
                best = np.append(_backtrack(steps, int(states.before[enough])), item)
        missing, done = need - states.gain, sums[item + 1]
        least = np.interp(missing + done, sums[item + 1 :], spent[item + 1 :]) - spent[item + 1]
        keep = (missing > 0) & (missing <= sums[-1] - done)
        keep &= states.cost + least < limit - 0.5 + 1e-12 * limit  # prices are whole numbers
        steps.append(_States(*(each[keep] for each in states)))
        if not keep.any():
            break
    return best


def _extend(states: _States, price: int, gain: int, need: int) -> _States:
    """Return the states without and with one more item; of equal states the one without it comes first."""
    cost = np.concatenate([states.cost, states.cost + price])
    sums = np.minimum(np.concatenate([states.gain, states.gain + gain]), need)
    before = np.tile(np.arange(len(states.cost)), 2)
    taken = np.repeat([False, True], len(states.cost))
    order = np.lexsort((taken, -sums, cost))
    best = np.maximum.accumulate(sums[order])
    keep = order[np.concatenate([[True], best[1:] > best[:-1]])]
    return _States(cost[keep], sums[keep], before[keep], taken[keep])


def _backtrack(steps: list[_States], state: int) -> Whole:
    """Return the items of a state of the last step."""
    items = []
    for item in range(len(steps) - 1, 0, -1):
        step = steps[item]
        if step.taken[state]:
            items.append(item - 1)
        state = int(step.before[state])
    return np.array(items[::-1], np.int64)
