"""Choice of members to show: the typical, the smallest, the largest, an outlier, and representatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .ensemble import Ensemble
from .statistics import burned_areas, depths, overlaps

LINES = 6
"""Usual number of other members that are drawn: few, spread out, and close to the rest (Liu et al., IEEE TVCG
25(1), 2019). The number is by eye."""


@dataclass(frozen=True, eq=False)
class Choice:
    """Indices of members, chosen by their burned areas at the horizon.

    Attributes
    ----------
    typical
        Deepest member by epsilon inclusion depth.
    smallest, largest
        By burned area.
    outlier
        Least deep member.
    area, depth
        (m,) burned areas, m2, and epsilon inclusion depths; NaN for members that end earlier.
    """

    typical: int
    smallest: int
    largest: int
    outlier: int
    area: NDArray[np.float64]
    depth: NDArray[np.float64]


def choose(ensemble: Ensemble) -> Choice:
    """Choose members by their burned areas at the horizon; of equal ones, the first.

    Raises
    ------
    Error
        No member reaches the horizon.
    """
    ensemble.counted_at_end()
    area = burned_areas(ensemble, [ensemble.horizon])[:, 0]
    depth = depths(ensemble, ensemble.horizon)
    rounded = np.round(depth, 6)  # sums of areas have rounding errors
    return Choice(
        typical=int(np.nanargmax(rounded)),
        smallest=int(np.nanargmin(area)),
        largest=int(np.nanargmax(area)),
        outlier=int(np.nanargmin(rounded)),
        area=area,
        depth=depth,
    )


def representatives(ensemble: Ensemble, count: int) -> list[int]:
    """Choose at most `count` members that stand for all: typical, outlier, largest, smallest, then others.

    Each next one is the member that most lowers the mean distance, 1 - Jaccard index of burned areas at the
    horizon, from every member to the nearest chosen one (greedy k-medoids; Kaufman and Rousseeuw, Finding
    Groups in Data, 1990, BUILD). Members count equally.
    """
    chosen, likeness = choose(ensemble), jaccard(overlaps(ensemble, ensemble.horizon))
    counted = np.flatnonzero(ensemble.counted(ensemble.horizon))
    first = (chosen.typical, chosen.outlier, chosen.largest, chosen.smallest)
    medoids = list(dict.fromkeys(first))[:count]
    while len(medoids) < min(count, len(counted)):
        near = likeness[counted][:, medoids].max(axis=1)
        gain = np.maximum(likeness[counted] - near[:, None], 0.0).sum(axis=0).round(6)  # (m,) of all members
        gain[[member for member in range(len(gain)) if member in medoids or member not in counted]] = -1.0
        medoids.append(int(gain.argmax()))
    return medoids


def jaccard(common: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the Jaccard index (m, m) of pairs from their common areas; of two empty areas it is 1."""
    own = np.diag(common)
    union = own[:, None] + own[None, :] - common
    return np.divide(common, union, out=np.ones_like(common), where=union > 0.0)
