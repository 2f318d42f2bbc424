"""Selection of observations for comparison: within the run's area and between its first and last time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

USED, BEFORE, AFTER, OUTSIDE = "used", "before", "after", "outside"
FATES = (USED, BEFORE, AFTER, OUTSIDE)


def fates(run: Run, moments: ArrayLike, here: ArrayLike) -> NDArray[np.str_]:
    """Use of each observation, one of `FATES`, by its model time (s) and whether it lies in the run's grid.

    One outside of the grid is `OUTSIDE` at any time: it may belong to another fire.
    """
    moments, here = np.asarray(moments, np.float64), np.asarray(here, bool)
    when = np.select([moments < run.times[0], moments > run.times[-1]], [BEFORE, AFTER], USED)
    return np.where(here, when, OUTSIDE)


def row(source: str, kind: str, fates_of: Iterable[str]) -> dict[str, Any]:
    """Count the observations of a file and kind ("perimeters", "detections") by use."""
    counts = Counter(str(fate) for fate in fates_of)
    return {"source": source, "kind": kind} | {fate: counts[fate] for fate in FATES}


def nothing(rows: Sequence[dict[str, Any]]) -> str:
    """Explain that no observation can be used, with reasons; "" if one can or there are none."""
    if not rows or any(counted[USED] for counted in rows):
        return ""
    before, after, outside = (sum(counted[fate] for counted in rows) for fate in FATES[1:])
    reasons = (
        (before, "before the run's first time"),
        (after, "after its last" if before else "after the run's last time"),
        (outside, "outside of its grid" if before or after else "outside of the run's grid"),
    )
    names = ", ".join(dict.fromkeys(counted["source"] for counted in rows))
    why = ", ".join(f"{count:,} lie {text}" for count, text in reasons if count)
    return f"no observation of {names} can be compared with the run: {why or 'all are left out'}"
