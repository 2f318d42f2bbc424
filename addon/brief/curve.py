"""Chart of burned area by time with reported areas, as SVG in the colours of the page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any
from zoneinfo import ZoneInfo

import numpy as np

from ..html_text import quote
from ..run import times
from ..run.fronts import Front
from ..run.score.measure import Measure
from . import units as page_units
from .sheet_options import Units

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


def axes(fronts: Sequence[Front], reported: Sequence[dict[str, Any]]) -> Axes:
    """Choose axes that cover the run and the reports within its time."""
    areas = [front.area for front in fronts] + [row["reported"] for row in _covered(reported)]
    return Axes(fronts[0].utc, fronts[-1].utc, max(*areas, 1.0) * 1.06)


def svg(fronts: Sequence[Front], reported: Sequence[dict[str, Any]], zone: str, units: Units = "us") -> str:
    """Draw the curve of the run and dots for reports; the axis of `units` is at the left, the other right."""
    second: Units = "metric" if units == "us" else "us"
    left, right = page_units.AREA[units], page_units.AREA[second]
    place = axes(fronts, reported)
    line = " ".join(f"{place.x(front.utc)},{place.y(front.area)}" for front in fronts)
    foot = HEIGHT - BOTTOM
    parts = [
        *scale(place, left, LEFT - 8, "end", True),
        *scale(place, right, WIDTH - RIGHT + 8, "start", False),
        *dates(place, zone),
        f'<polygon class="area" points="{LEFT},{foot} {line} {WIDTH - RIGHT},{foot}"/>',
        f'<polyline class="run" points="{line}"/>',
        f'<line id="cursor" class="cursor" x1="{LEFT}" x2="{LEFT}" y1="{TOP}" y2="{foot}"/>',
        *(_dot(place, row, zone, left) for row in _covered(reported)),
    ]
    label = "Burned area by time: run and reports; the table below has the numbers of the reports"
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{label}" class="curve">'
        + "".join(parts)
        + "</svg>"
    )


def _covered(reported: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Select the reports within the time of the run."""
    return [row for row in reported if row["run"] is not None]


def _dot(place: Axes, row: dict[str, Any], zone: str, unit: Measure) -> str:
    when = datetime.fromisoformat(row["time"])
    area = f"{unit.format(row['reported'])} {unit.name} reported"
    title = quote(f"{times.text(when, zone)}: {area} ({row['source']})")
    spot = f'cx="{place.x(when)}" cy="{place.y(row["reported"])}"'
    return f'<circle class="reported" r="5" {spot}><title>{title}</title></circle>'


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
