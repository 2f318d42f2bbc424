"""Quantities of the page in US and metric units; the units of the user come first."""

from __future__ import annotations

import math

from ..data.history import SQUARE_METRES_PER_ACRE
from ..run.measure import AREA, METRES, MILE, Measure, Units, area, ordered
from ..stations.arrival_text import format_distance

__all__ = ["AREA", "FUEL", "MILE", "SEPARATION", "area", "distance", "length", "number", "quantity"]

_CHAIN, _GALLON, _POUND = 20.1168, 3.785411784, 0.45359237  # m, l, kg (NIST Handbook 44, appendix C)
_US = {
    "l": ("gal", 1.0 / _GALLON),
    "l/min": ("gal/min", 1.0 / _GALLON),
    "kg": ("lb", 1.0 / _POUND),
    "m/h": ("chains/h", 1.0 / _CHAIN),
    "km/h": ("mph", 1000.0 / MILE),
    "km": ("mi", 1000.0 / MILE),
}
"""US unit and its number for one metric unit."""
_TON = 2000.0 * _POUND  # short ton, kg

SEPARATION: dict[Units, Measure] = {"us": Measure("mi", 1.0 / MILE, 2), "metric": METRES}
FUEL: dict[Units, Measure] = {
    "us": Measure("tons/acre", SQUARE_METRES_PER_ACRE / _TON),
    "metric": Measure("kg/m²", 1.0),
}
"""Units of tables and legends with one unit: burned area, distance of perimeters, fuel load."""


def distance(metres: float, units: Units) -> str:
    """Format a distance in miles and metric units, with two digits, rounded up: ``0.09 mi (140 m)``."""
    miles = max(metres / MILE, 0.01)
    digits = max(0, min(2, 1 - math.floor(math.log10(max(miles, 0.1)))))
    up = math.ceil(round(miles * 10.0**digits, 6)) / 10.0**digits
    return ordered(f"{up:,.{digits}f} mi", format_distance(metres), units)


def length(metres: float, units: Units) -> str:
    """Format the length of a line of work in chains and metres."""
    return ordered(f"{metres / _CHAIN:,.0f} chains", f"{metres:,.0f} m", units)


def quantity(value: float, unit: str, units: Units) -> str:
    """Format a value in a metric unit, and in a US unit if there is one: ``500 gal (1,893 l)``."""
    metric = f"{number(value)} {unit}".strip()
    if unit not in _US:
        return metric
    name, factor = _US[unit]
    return ordered(f"{number(value * factor)} {name}", metric, units)


def number(value: float) -> str:
    """Format a number with three digits or all digits before the point."""
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.3g}"
