"""Two groups of members: a forecast with two outcomes, of which no single member or median tells both."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

LEAST = 10
"""Number of members from which on groups are looked for."""
_SMALLEST = 0.15  # share of the members in the smaller group
_WIDTH = 0.8
"""Mean silhouette width from which on there are two groups. By simulation, samples of 20 values from one
uniform, normal or exponential distribution exceed it in at most 2 % of cases, and from two normal
distributions 8 standard deviations apart in 96 %. Kaufman and Rousseeuw (Finding Groups in Data, 1990) call
more than 0.7 a strong structure."""


def split(distance: NDArray[np.float64]) -> NDArray[np.bool_] | None:
    """Split members into two groups by their distances (m, m), if these are clearly apart.

    Returns
    -------
    second
        (m,) True for members of the other group than the first member's; None: one group.
    """
    count = len(distance)
    if count < LEAST:
        return None
    second = _around_medoids(distance)
    smaller = min(int(second.sum()), count - int(second.sum()))
    if smaller < max(2, _SMALLEST * count) or _silhouette(distance, second) <= _WIDTH:
        return None
    return second ^ second[0]


def split_values(values: ArrayLike) -> NDArray[np.bool_] | None:
    """Split values (m,), such as arrival times, into two groups if these are clearly apart."""
    found = np.asarray(values, np.float64)
    return split(np.abs(found[:, None] - found))


def _around_medoids(distance: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Assign members (m,) to the nearer one of the two medoids with the least sum of distances (exact)."""
    best, pair = np.inf, (0, 0)
    for first, row in enumerate(distance):
        sums = np.minimum(row, distance).sum(axis=1)
        second = int(sums.argmin())
        if sums[second] < best:
            best, pair = float(sums[second]), (first, second)
    return distance[pair[0]] > distance[pair[1]]


def _silhouette(distance: NDArray[np.float64], second: NDArray[np.bool_]) -> float:
    """Compute the mean silhouette width of two groups (Rousseeuw, J. Comput. Appl. Math. 20, 1987)."""
    sums = np.stack([distance[:, ~second].sum(axis=1), distance[:, second].sum(axis=1)])
    sizes = np.array([(~second).sum(), second.sum()])
    own, members = second.astype(np.int64), np.arange(len(second))
    inside = sums[own, members] / np.maximum(sizes[own] - 1, 1)
    outside = sums[1 - own, members] / sizes[1 - own]
    larger = np.maximum(inside, outside)
    width = np.divide(outside - inside, larger, out=np.zeros_like(larger), where=larger > 0.0)
    return float(np.where(sizes[own] > 1, width, 0.0).mean())
