"""Chart of burned area by time with reported areas, as SVG in the colours of the page."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from ..html_text import quote
from ..run import times
from ..run.area_chart import BOTTOM, HEIGHT, LEFT, RIGHT, TOP, WIDTH, Axes, dates, scale
from ..run.fronts import Front
from ..run.measure import AREA, Measure, Units


def axes(fronts: Sequence[Front], reported: Sequence[dict[str, Any]]) -> Axes:
    """Choose axes that cover the run and the reports within its time."""
    areas = [front.area for front in fronts] + [row["reported"] for row in _covered(reported)]
    return Axes(fronts[0].utc, fronts[-1].utc, max(*areas, 1.0) * 1.06)


def svg(fronts: Sequence[Front], reported: Sequence[dict[str, Any]], zone: str, units: Units = "us") -> str:
    """Draw the curve of the run and dots for reports; the axis of `units` is at the left, the other right."""
    second: Units = "metric" if units == "us" else "us"
    left, right = AREA[units], AREA[second]
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
