"""Units of the columns of the score tables."""

from __future__ import annotations

from dataclasses import dataclass

from ...data.history import SQUARE_METRES_PER_ACRE


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
