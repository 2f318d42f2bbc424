"""What the numbers of fuel models say of the fuel: grass, shrub, litter, slash or what does not burn.

Numbers are those of Anderson 1982 (GTR INT-122), 1 to 13, and of Scott and Burgan 2005 (RMRS-GTR-153) as
LANDFIRE gives them, 91 to 204. 14 is what WRF-SFIRE calls its category without fuel.
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
"""By kind. A litter's fuel is dead leaves and needles under trees, with or without an understorey."""

URBAN, SNOW, FARMLAND, WATER, BARE = 91, 92, 93, 98, 99
"""Scott and Burgan's numbers of what does not burn."""

NUMBERS = {
    GRASS: ((1, 3), (101, 109), (121, 124)),  # GR, and GS where grass carries the fire among shrubs
    SHRUB: ((4, 7), (141, 149)),
    LITTER: ((8, 10), (161, 165), (181, 189)),  # TU and TL
    SLASH: ((11, 13), (201, 204)),
    UNBURNABLE: ((14, 14), (URBAN, BARE)),
}
"""First and last numbers of each kind."""

IMPLIED = 0.8  # kg/m2 of canopy fuel over litter, where a model brings none: a middling stand (assumed)
_LARGEST = 255
_CANOPY = 0.01  # kg/m2, less is none


def kinds(category: NDArray) -> NDArray[np.uint8]:
    """Kind of each number of a fuel model, of whatever shape; UNKNOWN where it is none that is known.

    Parameters
    ----------
    category
        Numbers of fuel models, NaN where there is none.
    """
    table = np.full(_LARGEST + 1, UNKNOWN, np.uint8)
    for kind, spans in NUMBERS.items():
        for first, last in spans:
            table[first : last + 1] = kind
    whole = np.nan_to_num(np.asarray(category, np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    return table[np.clip(np.rint(whole), 0, _LARGEST).astype(np.int64)]


def rows(run: Run) -> Iterator[tuple[int, int, NDArray[np.uint8]]]:
    """First and last rows, and the kinds (rows, fx) there, of a run with categories; part by part."""
    for first, end in blocks.rows(run):
        yield first, end, kinds(run.fuel_rows(FIELD, first, end))


def shares(run: Run) -> dict[str, float] | None:
    """Part of the fuel grid's cells that each kind has, by name; None: the run has no categories."""
    if not run.has(FIELD):
        return None
    count = np.zeros(len(NAMES))
    for _, _, found in rows(run):
        count += np.bincount(found.ravel(), minlength=len(NAMES))
    return dict(zip(NAMES, (count / max(count.sum(), 1.0)).tolist(), strict=True))


def canopy(run: Run) -> NDArray[np.float32]:
    """Canopy fuel (fy, fx), kg/m2, that trees are drawn by: the run's, and `IMPLIED` over litter without any.

    Litter is of trees. Where some of the run's litter has canopy, that without it is a clearing.
    """
    known = run.canopy_fuel
    if not run.has(FIELD):
        return known
    litter = kinds(run.fuel_rows(FIELD, 0, len(run.fuel_latitude))) == LITTER
    if not litter.any() or (known[litter] > _CANOPY).any():
        return known
    return np.where(litter, np.float32(IMPLIED), known)
