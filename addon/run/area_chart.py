"""Axes of charts of burned area by time, as SVG in the colours of a page."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np

from .measure import Measure

WIDTH, HEIGHT = 900, 300  # of the drawing, which the page scales
LEFT, RIGHT, TOP, BOTTOM = 66, 58, 20, 52
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
_HOURS = (1, 2, 3, 6, 12, 24, 48, 96, 240)
_MOST_DATES = 7


@dataclass(frozen=True)
class Axes:
    """Coordinates in the drawing for times (UTC) and areas (m2)."""

    first: datetime
    last: datetime
    high: float

    def x(self, when: datetime) -> float:
        """Return the horizontal coordinate of a time."""
        span = max((self.last - self.first).total_seconds(), 1.0)
        share = (when - self.first).total_seconds() / span
        return round(LEFT + share * (WIDTH - LEFT - RIGHT), 1)

    def y(self, area: float) -> float:
        """Return the vertical coordinate of an area."""
        return round(HEIGHT - BOTTOM - area / self.high * (HEIGHT - TOP - BOTTOM), 1)


def scale(place: Axes, unit: Measure, x: float, anchor: str, lines: bool) -> Iterator[str]:
    """Draw the ticks of an area axis."""
    high = place.high * unit.factor
    power = 10.0 ** np.floor(np.log10(high / 4.0))
    step = next(step * power for step in _STEPS if step * power >= high / 4.0 * 0.999)
    for value in np.arange(0.0, high, step):
        y = place.y(float(value) / unit.factor)
        if lines:
            yield f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y}" y2="{y}"/>'
        yield f'<text x="{x}" y="{y + 4}" text-anchor="{anchor}" class="{anchor}">{value:,g}</text>'
    yield f'<text x="{x}" y="{TOP - 6}" text-anchor="{anchor}" class="unit {anchor}">{unit.name}</text>'


def dates(place: Axes, zone: str) -> Iterator[str]:
    """Draw ticks at round local hours below the curve."""
    hours = (place.last - place.first).total_seconds() / 3600.0
    if hours < 2.0:
        ticks = [place.first, place.last]
    else:
        step = next((step for step in _HOURS if hours / step <= _MOST_DATES), int(hours / _MOST_DATES) + 1)
        start = place.first.astimezone(ZoneInfo(zone)).replace(hour=0, minute=0, second=0, microsecond=0)
        count = int((hours + 24.0) / step) + 2
        every = [start + timedelta(hours=step * k) for k in range(count)]
        ticks = [tick for tick in every if place.first <= tick <= place.last]
    for tick in ticks:
        local, x = tick.astimezone(ZoneInfo(zone)), place.x(tick)
        foot = HEIGHT - BOTTOM
        yield f'<line class="tick" x1="{x}" x2="{x}" y1="{foot}" y2="{foot + 5}"/>'
        yield f'<text x="{x}" y="{foot + 20}" text-anchor="middle">{local:%H:%M}</text>'
        yield f'<text x="{x}" y="{foot + 42}" text-anchor="middle" class="day">{local.day} {local:%b}</text>'
