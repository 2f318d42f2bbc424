"""Words that a film adds to its captions, maps and mark, and rules for letters.

A translation of the words is in the story file.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from ..run import measure
from ..run.measure import Units
from ..shot.schema import key

SAFE = 0.05
"""Margin of letters, of the picture's width and height: the graphics safe area of EBU R 95."""
LETTERS = 1 / 26
"""Least size of letters, of the picture's height."""

_MONTHS = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec"
_NUMBER = "{}"
_REAL_TIME = 1.05  # times real time, below which the speed is called so


def _needs_number(text: str) -> str | None:
    return None if text.count(_NUMBER) == 1 else f'must have "{_NUMBER}" once, for the number'


def _needs_months(text: str) -> str | None:
    return None if len(text.split()) == 12 else "must have twelve months, with spaces between them"


@dataclass(frozen=True)
class Words:
    """Words that the film adds."""

    synthetic: str = key("synthetic", "mark of a film of a synthetic run")
    simulation: str = key("simulation", "mark of other films")
    speed: str = key("{} x", "speed, times real time", check=_needs_number)
    real_time: str = key("real time", "speed of real time")
    burned: str = key("{} burned", "burned area", check=_needs_number)
    growth: str = key("+{} an hour", "growth of the burned area", check=_needs_number)
    acres: str = key(measure.AREA["us"].name, "unit of area")
    hectares: str = key(measure.AREA["metric"].name, "unit of area")
    kilometres: str = key("km", "unit of the scale bar")
    metres: str = key("m", "unit of the scale bar")
    north: str = key("N", "north of maps")
    months: str = key(_MONTHS, "months of dates", check=_needs_months)

    def mark(self, synthetic: bool) -> str:
        """Return the mark of a film."""
        return self.synthetic if synthetic else self.simulation

    def pace(self, speed: float) -> str:
        """Format a speed: ``25 x``, or ``real time``."""
        if speed < _REAL_TIME:
            return self.real_time
        return self.speed.replace(_NUMBER, rounded(speed))

    def area(self, square_metres: float, units: Units) -> str:
        """Format a burned area: ``1,234 acres (499 ha) burned``."""
        return self.burned.replace(_NUMBER, self._units(measure.area(square_metres, units)))

    def rate(self, square_metres: float, units: Units) -> str:
        """Format the growth of the burned area in an hour: ``+1,440 acres an hour``."""
        unit = measure.AREA[units]
        return self.growth.replace(
            _NUMBER, self._units(f"{rounded(square_metres * unit.factor)} {unit.name}")
        )

    def _units(self, text: str) -> str:
        names = {measure.AREA["us"].name: self.acres, measure.AREA["metric"].name: self.hectares}
        return _replaced(text, names)

    def length(self, metres: float) -> str:
        """Format the length of a scale bar: ``500 m``, ``2 km``."""
        if metres >= 1000.0:
            return f"{metres / 1000.0:g} {self.kilometres}"
        return f"{metres:g} {self.metres}"

    def date(self, text: str) -> str:
        """Replace the months in a time."""
        return _replaced(text, dict(zip(_MONTHS.split(), self.months.split(), strict=True)))


def rounded(number: float) -> str:
    """Format a number with three digits: ``1,230``."""
    return f"{float(f'{number:.3g}'):,g}"


def _replaced(text: str, names: dict[str, str]) -> str:
    return re.sub(rf"\b({'|'.join(names)})\b", lambda match: names[match[0]], text)
