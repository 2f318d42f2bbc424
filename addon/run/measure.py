"""Units of quantities on pages: areas and lengths, in US and metric units."""

from __future__ import annotations

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
        Number of these units in one SI unit (m, m2 or kg/m2).
    digits
        Digits after the point.
    """

    name: str
    factor: float
    digits: int = 0

    def format(self, value: float) -> str:
        """Format a value in SI units as a number of this unit."""
        return f"{value * self.factor:,.{self.digits}f}"


ACRES = Measure("acres", 1.0 / SQUARE_METRES_PER_ACRE)
METRES = Measure("m", 1.0)
AREA: dict[Units, Measure] = {"us": ACRES, "metric": Measure("ha", 1e-4)}


def area(square_metres: float, units: Units) -> str:
    """Format an area in acres and hectares."""
    us, metric = (f"{each.format(square_metres)} {each.name}" for each in (AREA["us"], AREA["metric"]))
    return ordered(us, metric, units)


def ordered(us: str, metric: str, units: Units) -> str:
    """Put the quantity in the second units into brackets."""
    return f"{us} ({metric})" if units == "us" else f"{metric} ({us})"
