"""Fuel categories: kind of fuel (grass, shrub, litter, slash, unburnable) by fuel model number.

Numbers 1 to 13 are Anderson's (1982, GTR INT-122). Numbers 91 to 204 are Scott and Burgan's (2005,
RMRS-GTR-153) as LANDFIRE writes them. 14 is WRF-SFIRE's category without fuel.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from . import blocks

FIELD = "fuel_category"
UNKNOWN, GRASS, SHRUB, LITTER, SLASH, UNBURNABLE = range(6)
NAMES = ("unknown", "grass", "shrub", "litter", "slash", "unburnable")
"""Names by kind. Litter is dead leaves and needles under trees, with or without an understorey."""

URBAN, SNOW, FARMLAND, WATER, BARE = 91, 92, 93, 98, 99
"""Scott and Burgan's numbers of unburnable ground."""

NUMBERS = {
    GRASS: ((1, 3), (101, 109), (121, 124)),  # GR, and GS, in which grass carries the fire among shrubs
    SHRUB: ((4, 7), (141, 149)),
    LITTER: ((8, 10), (161, 165), (181, 189)),  # TU and TL
    SLASH: ((11, 13), (201, 204)),
    UNBURNABLE: ((14, 14), (URBAN, BARE)),
}
"""Ranges of fuel model numbers of each kind."""

IMPLIED = 0.8  # kg/m2, canopy fuel over litter if a model has none: an average stand (assumed)
_LARGEST = 255
_CANOPY = 0.01  # kg/m2; less counts as none


def kinds(category: NDArray) -> NDArray[np.uint8]:
    """Look up the kind of each fuel model number, of any shape; UNKNOWN for other numbers.

    Parameters
    ----------
    category
        Fuel model numbers, NaN without data.
    """
    table = np.full(_LARGEST + 1, UNKNOWN, np.uint8)
    for kind, spans in NUMBERS.items():
        for first, last in spans:
            table[first : last + 1] = kind
    whole = np.nan_to_num(np.asarray(category, np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    return table[np.clip(np.rint(whole), 0, _LARGEST).astype(np.int64)]


def rows(run: Run) -> Iterator[tuple[int, int, NDArray[np.uint8]]]:
    """Read blocks of a run with categories: first and last rows, and the kinds (rows, fx)."""
    for first, end in blocks.rows(run):
        yield first, end, kinds(run.fuel_rows(FIELD, first, end))


def shares(run: Run) -> dict[str, float] | None:
    """Compute the fraction of fuel cells of each kind, by name; None if the run has no categories."""
    if not run.has(FIELD):
        return None
    count = np.zeros(len(NAMES))
    for _, _, block in rows(run):
        count += np.bincount(block.ravel(), minlength=len(NAMES))
    return dict(zip(NAMES, (count / max(count.sum(), 1.0)).tolist(), strict=True))


def canopy(run: Run) -> NDArray[np.float32]:
    """Compute the canopy fuel (fy, fx), kg/m2, for drawing trees: the run's, or `IMPLIED` over litter.

    Litter implies trees. If some of the run's litter has canopy fuel, litter without it is a clearing.
    """
    given = run.canopy_fuel
    if not run.has(FIELD):
        return given
    litter = kinds(run.fuel_rows(FIELD, 0, len(run.fuel_latitude))) == LITTER
    if not litter.any() or (given[litter] > _CANOPY).any():
        return given
    return np.where(litter, np.float32(IMPLIED), given)
