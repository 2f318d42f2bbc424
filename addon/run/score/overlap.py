"""Overlap scores of a simulated and an observed burned area.

Names and definitions follow Duff, Chong & Tolhurst, Environmental Modelling & Software 83 (2016), and
`firebench`. Kappa is Cohen's, which meteorologists call the Heidke skill score.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


@dataclass(frozen=True)
class Overlap:
    """Confusion matrix of burned areas, m2.

    Attributes
    ----------
    both
        Burned in the run and observed: hits.
    run_only
        Burned in the run only: false alarms.
    seen_only
        Observed only: misses.
    neither
        Correct negatives in the domain. Kappa depends on it, and so on the domain's size.
    """

    both: float
    run_only: float
    seen_only: float
    neither: float

    @classmethod
    def of_polygons(cls, run: BaseGeometry, seen: BaseGeometry, domain: BaseGeometry) -> Overlap:
        """Compute from polygons in an equal-area projection; observed area outside the domain is a miss."""
        both = run.intersection(seen).area
        union = run.area + seen.area - both
        return cls(both, run.area - both, seen.area - both, max(domain.area - union, 0.0))

    @classmethod
    def of_cells(cls, run: NDArray, seen: NDArray[np.bool_], areas: NDArray[np.float64]) -> Overlap:
        """Compute from cells and their areas. `run` is a burned mask or burned fraction.

        In an observed cell the burned fraction is a hit and the rest a miss.
        """
        burned = run * areas
        rest = areas - burned
        parts = (burned[seen], burned[~seen], rest[seen], rest[~seen])
        return cls(*(float(part.sum()) for part in parts))

    def scores(self) -> dict[str, float | None]:
        """Compute all scores by name; None if the denominator is 0."""
        tp, fp, fn, tn = self.both, self.run_only, self.seen_only, self.neither
        chance = (tp + fn) * (fn + tn) + (tp + fp) * (fp + tn)
        return {
            "area": tp + fp,
            "observed_area": tp + fn,
            "hits": tp,
            "false_alarms": fp,
            "misses": fn,
            "area_bias": _ratio(fp - fn, tp + fn),
            "sorensen": _ratio(2 * tp, 2 * tp + fp + fn),
            "jaccard": _ratio(tp, tp + fp + fn),
            "kappa": _ratio(2 * (tp * tn - fp * fn), chance),
            "precision": _ratio(tp, tp + fp),
            "recall": _ratio(tp, tp + fn),
            "sdi": _ratio(fp + fn, tp + fn),
            "sdi_over": _ratio(fp, tp + fn),
            "sdi_under": _ratio(fn, tp + fn),
            "adi": _ratio(fp + fn, tp),
            "adi_over": _ratio(fp, tp),
            "adi_under": _ratio(fn, tp),
        }


HELP: dict[str, str] = {
    "sorensen": "2 hits / (2 hits + false alarms + misses); 1 is a perfect match",
    "jaccard": "hits / (hits + false alarms + misses); 1 is a perfect match",
    "kappa": "agreement beyond chance; depends on the domain",
    "precision": "fraction of the simulated burned area that was observed",
    "recall": "fraction of the observed burned area that the run burned",
    "sdi": "shape deviation index: (false alarms + misses) / observed; 0 is a perfect match",
    "adi": "area difference index: (false alarms + misses) / hits; 0 is a perfect match",
}


def _ratio(part: float, whole: float) -> float | None:
    return part / whole if whole > 0.0 else None
