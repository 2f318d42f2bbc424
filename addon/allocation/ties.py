"""What makes an allocation the same each time: weights that break ties, and classes of alike resources."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .problem import SMALLEST, Problem

Array = NDArray[np.float64]


def ranks(problem: Problem) -> tuple[Array, Array]:
    """Additions to the costs (n, k) and losses (k, t) that break ties; below half `SMALLEST` in sum.

    Fewer resources, lower ids, divisions nearer the first and earlier hours are preferred. Weights are
    logarithms of prime numbers, no two sets of which have the same sum.
    """
    n, k = problem.minutes.shape
    weight = np.log(_primes(n * k)).reshape(n, k)
    hours = np.broadcast_to(problem.hours / (problem.hours[-1] + 1.0), problem.perimeter.shape)
    scale = 0.25 * SMALLEST
    return scale * weight / max(weight.sum(), 1.0), scale * hours / (1e3 * max(k, 1))


def _primes(count: int) -> NDArray[np.int64]:
    """The first prime numbers (sieve; the n-th is below n (log n + log log n) + 9)."""
    most = int(count * (np.log(count + 1.0) + np.log(np.log(count + 3.0) + 1.0))) + 12
    sieve = np.ones(most, bool)
    sieve[:2] = False
    for number in range(2, int(most**0.5) + 1):
        sieve[number * number :: number] &= not sieve[number]
    return np.flatnonzero(sieve)[:count]


def alike(problem: Problem) -> list[NDArray[np.int64]]:
    """Indices of resources that differ in their id alone, in lists, which are in the order of their first."""
    kinds = [problem.types.index(kind) for kind in problem.types]
    rows = np.column_stack([kinds, problem.rate, problem.cost, problem.minutes])
    _, first, member = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    member = member.reshape(-1)
    return [np.flatnonzero(member == each) for each in np.argsort(first)]
