"""Quantities of the page in US and metric units; the units of the user come first."""

from __future__ import annotations

import math

from ..data.history import SQUARE_METRES_PER_ACRE
from ..stations.arrival_text import format_distance
from .sheet_options import Units

MILE = 1609.344
"""International mile, m."""
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


def area(square_metres: float, units: Units) -> str:
    """Format an area in acres and hectares."""
    return _ordered(f"{acres(square_metres):,.0f} acres", f"{square_metres / 1e4:,.0f} ha", units)


def acres(square_metres: float) -> float:
    """Convert square metres to acres."""
    return square_metres / SQUARE_METRES_PER_ACRE


def distance(metres: float, units: Units) -> str:
    """Format a distance in miles and metric units, with two digits, rounded up: ``0.09 mi (140 m)``."""
    miles = max(metres / MILE, 0.01)
    digits = max(0, min(2, 1 - math.floor(math.log10(max(miles, 0.1)))))
    up = math.ceil(round(miles * 10.0**digits, 6)) / 10.0**digits
    return _ordered(f"{up:,.{digits}f} mi", format_distance(metres), units)


def length(metres: float, units: Units) -> str:
    """Format the length of a line of work in chains and metres."""
    return _ordered(f"{metres / _CHAIN:,.0f} chains", f"{metres:,.0f} m", units)


def quantity(value: float, unit: str, units: Units) -> str:
    """Format a value in a metric unit, and in a US unit if there is one: ``500 gal (1,893 l)``."""
    metric = f"{number(value)} {unit}".strip()
    if unit not in _US:
        return metric
    name, factor = _US[unit]
    return _ordered(f"{number(value * factor)} {name}", metric, units)


def number(value: float) -> str:
    """Format a number with three digits or all digits before the point."""
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def _ordered(us: str, metric: str, units: Units) -> str:
    return f"{us} ({metric})" if units == "us" else f"{metric} ({us})"
