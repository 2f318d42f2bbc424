"""Phenology of deciduous trees: autumn colour, fallen leaves and budburst by date and latitude.

The dates were observed in Harvard Forest, 42.5 degrees north, to the week: buds open about day 125, half of
the leaves have turned by day 282 and fallen by day 295 (O'Keefe 2000, Harvard Forest Data Archive HF003).
Their change with latitude is assumed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...shot.terrain import noise

_AT = 42.5  # degrees, latitude of the dates
_SPRING, _AUTUMN = 1.4, -0.5  # days later for each degree polewards (assumed)
_OPEN, _TURN, _FALL = (112.0, 138.0), (268.0, 297.0), (280.0, 312.0)  # day of the year: start and end
_YEAR = 365.25  # days
_DROUGHT = 0.45  # fraction of the leaves that trees of the dry tropics lose (assumed)


class LeafState(NamedTuple):
    """State of deciduous leaves: fractions 0..1 that have turned, and that have fallen."""

    turned: float = 0.0
    fallen: float = 0.0


def in_winter(day: float, latitude: float) -> LeafState:
    """State of leaves that fall in autumn, on a day of the year at a latitude (degrees)."""
    if latitude < 0.0:
        day = (day + 0.5 * _YEAR) % _YEAR
    off = float(np.clip(abs(latitude) - _AT, -15.0, 25.0))

    def part(span: tuple[float, float], later: float) -> float:
        low, high = (time + later * off for time in span)
        return float(noise.smoothstep(low, high, np.array(day)))

    bare = 1.0 - part(_OPEN, _SPRING)
    if day < 200.0:
        return LeafState(bare, bare)
    return LeafState(part(_TURN, _AUTUMN), part(_FALL, _AUTUMN))


def in_drought(green: float) -> LeafState:
    """State of leaves that fall in the dry season, by the greenness of the season."""
    return LeafState(1.0 - green, _DROUGHT * (1.0 - green))


def of_kind(kind: str, day: float, latitude: float, green: float) -> LeafState:
    """State of leaves by the kind of fall: "winter", "drought", or "" for evergreen."""
    if kind == "winter":
        return in_winter(day, latitude)
    return in_drought(green) if kind == "drought" else LeafState()
