"""Units of quantities on pages and in films: areas, lengths and speeds, in US and metric units."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ..data.history import SQUARE_METRES_PER_ACRE

Units = Literal["us", "metric"]
"""Units that come first."""


@dataclass(frozen=True)
class Measure:
    """Unit of a quantity.

    Attributes
    ----------
    name
        Short name, as in a column title.
    factor
        Number of these units in one SI unit (m, m2, m/s or kg/m2).
    digits
        Digits after the point.
    """

    name: str
    factor: float
    digits: int = 0

    def format(self, value: float) -> str:
        """Format a value in SI units as a number of this unit."""
        return f"{value * self.factor:,.{self.digits}f}"


MILE = 1609.344
"""International mile, m."""
ACRES = Measure("acres", 1.0 / SQUARE_METRES_PER_ACRE)
METRES = Measure("m", 1.0)
MILES_PER_HOUR = Measure("mph", 3600.0 / MILE)
AREA: dict[Units, Measure] = {"us": ACRES, "metric": Measure("ha", 1e-4)}


def area(square_metres: float, units: Units) -> str:
    """Format an area in acres and hectares."""
    us, metric = (f"{each.format(square_metres)} {each.name}" for each in (AREA["us"], AREA["metric"]))
    return ordered(us, metric, units)


def ordered(us: str, metric: str, units: Units) -> str:
    """Put the quantity in the second units into brackets."""
    return f"{us} ({metric})" if units == "us" else f"{metric} ({us})"


def round_length(most: float) -> float:
    """Return the largest round length up to `most` for a scale bar: 1, 2 or 5 times a power of ten."""
    unit = 10.0 ** math.floor(math.log10(most))
    return max(step * unit for step in (1, 2, 5) if step * unit <= most)
