"""The nearest resource of each kind for each division, no resource twice."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .model import scipy
from .problem import Problem


class Nearest(NamedTuple):
    """A resource of a kind for a division, by their indices, and its minutes to there."""

    kind: str
    division: int
    resource: int
    minutes: float


def nearest(problem: Problem) -> list[Nearest]:
    """Nearest resources by kind: of all pairings of one each, that of the least sum of minutes.

    With fewer resources of a kind than divisions some divisions have none.
    """
    found = []
    for kind in sorted({each.partition("/")[0] for each in problem.types}):
        members = np.flatnonzero(problem.of(kind))
        division, chosen = pair(problem.minutes[members].T)
        found += [
            Nearest(kind, int(k), int(members[i]), float(problem.minutes[members[i], k]))
            for k, i in zip(division, chosen, strict=True)
        ]
    return found


def pair(minutes: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows and columns of the pairing with the least sum (Crouse 2016, in SciPy), one to one."""
    return scipy().linear_sum_assignment(minutes)
