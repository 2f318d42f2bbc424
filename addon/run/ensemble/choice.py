"""Choice of members to show: the typical, the smallest, the largest, an outlier, and a spread of others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .ensemble import Ensemble
from .statistics import burned_areas, depths, overlaps

MOST_LINES = 15
"""Members that a reader can tell apart on a map (Liu et al., 2019: a few that spread), plus the shown one."""


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
    """Choose members by their burned areas at the horizon; of equal ones, the first."""
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


def spread(ensemble: Ensemble, shown: int, most: int = MOST_LINES) -> list[int]:
    """Choose at most `most` other members than the shown one, as different as possible.

    Each next one is the member whose largest Jaccard index with those chosen before is lowest (farthest-point
    sampling; Gonzalez, Theoretical Computer Science 38, 1985), so that an outlier is among the first.
    """
    counted = np.flatnonzero(ensemble.counted(ensemble.horizon))
    likeness = jaccard(overlaps(ensemble, ensemble.horizon))
    chosen = [shown]
    while len(chosen) <= most:
        left = [member for member in counted if member not in chosen]
        if not left:
            break
        chosen.append(int(min(left, key=lambda member: likeness[member, chosen].max())))
    return chosen[1:]


def jaccard(common: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the Jaccard index (m, m) of pairs from their common areas; of two empty areas it is 1."""
    own = np.diag(common)
    union = own[:, None] + own[None, :] - common
    return np.divide(common, union, out=np.ones_like(common), where=union > 0.0)
