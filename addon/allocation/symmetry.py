"""Symmetry: classes of interchangeable resources, which the integer program counts instead of naming each.

Two assignments that differ only by which members of a class go where have equal cost and equal line. A count
by class and division represents all of them, so the search visits one of them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .problem import Problem

Whole = NDArray[np.int64]


def find_classes(problem: Problem) -> list[Whole]:
    """Return the classes: ascending indices of resources that differ by their ids alone, by first member."""
    kinds = [problem.types.index(kind) for kind in problem.types]
    rows = np.column_stack([kinds, problem.rate, problem.cost, problem.minutes])
    _, first, member = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    member = member.reshape(-1)
    return [np.flatnonzero(member == each) for each in np.argsort(first)]


def assign(classes: Sequence[Whole], counts: Whole) -> Whole:
    """Return the division (n,) of each resource, -1 if it is not sent.

    The members of a class with the lowest ids are sent, in the order of the divisions.

    Parameters
    ----------
    counts
        (c, k) resources of each class that are sent to each division.
    """
    division = np.full(sum(map(len, classes)), -1)
    for members, number in zip(classes, counts, strict=True):
        sent = np.repeat(np.arange(counts.shape[1]), number)
        division[members[: len(sent)]] = sent
    return division
