"""Nearest resource of each kind for each division; each resource is used once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .model import import_scipy
from .problem import Problem


class Nearest(NamedTuple):
    """Resource of a kind for a division, as indices, and its travel time, min."""

    kind: str
    division: int
    resource: int
    minutes: float


def pair_nearest(problem: Problem) -> list[Nearest]:
    """Pair the resources of each kind with divisions so that the sum of travel times is minimal.

    With fewer resources of a kind than divisions, some divisions get none.
    """
    pairs = []
    for kind in sorted({each.partition("/")[0] for each in problem.types}):
        members = np.flatnonzero(problem.of(kind))
        division, chosen = pair_times(problem.minutes[members].T)
        pairs += [
            Nearest(kind, int(k), int(members[i]), float(problem.minutes[members[i], k]))
            for k, i in zip(division, chosen, strict=True)
        ]
    return pairs


def pair_times(minutes: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return rows and columns of the one-to-one pairing with the smallest sum (Crouse 2016, in SciPy)."""
    return import_scipy().linear_sum_assignment(minutes)
