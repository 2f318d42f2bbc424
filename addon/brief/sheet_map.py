"""Content of the frame of the map sheet, and the rows of its legend, from the same styles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from zoneinfo import ZoneInfo

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import metres_per_degree
from ..geometry.rectangles import overlap
from ..html_text import quote
from ..imaging import map_symbols
from ..run import times
from ..run.fronts import Front
from . import base_map, context, line_labels, units
from .briefing import Briefing
from .context import Context
from .map_frame import MapFrame

_HOURS = (1, 2, 3, 6, 12, 24, 48, 96)
_MOST_FRONTS = 9
_NEAR = 0.15  # mm, least step of a drawn line
_LEAST = 2.5  # mm, least size of an island or a spot
_ZONE_OPACITY = 0.22

Array = NDArray[np.float64]


@dataclass
class Content:
    """Drawing of the frame.

    Attributes
    ----------
    lines, points, labels
        SVG elements, in the order of drawing.
    legend
        Drawing in a box of 9 x 4 mm by text, in the order of first use.
    taken, stations
        Boxes of symbols and labels; positions and names of drawn stations, mm.
    """

    frame: MapFrame
    unit: float
    lines: list[str] = field(default_factory=list)
    points: list[str] = field(default_factory=list)
    labels: list[str] = field(default_factory=list)
    legend: dict[str, str] = field(default_factory=dict)
    taken: list[tuple[float, float, float, float]] = field(default_factory=list)
    stations: list[tuple[float, float, str]] = field(default_factory=list)

    def line(self, style: str, points: Array, closed: bool, text: str, fill: float = 0.0) -> None:
        """Draw a line or an outline through degrees east and north (n, 2)."""
        symbol = map_symbols.LINES[style]
        x, y = self.frame.place(points[:, 1], points[:, 0])
        at = _thinned(np.column_stack([x, y]))
        low, high = at.min(axis=0), at.max(axis=0)
        frame = self.frame
        if len(at) < 2 or not overlap(
            (*low, *high), (frame.left, frame.top, frame.left + frame.width, frame.top + frame.height)
        ):
            return
        if fill:
            data = "M" + " ".join(f"{a:.2f},{b:.2f}" for a, b in at) + "Z"
            self.lines.append(f'<path d="{data}" fill="{symbol.colour}" fill-opacity="{fill}"/>')
        self.lines += map_symbols.line(symbol, at, closed, self.unit)
        box = f'<rect x="-4" y="-1.4" width="8" height="2.8" fill="{symbol.colour}" fill-opacity="{fill}"/>'
        row = np.array([[-4.0, 0.0], [4.0, 0.0]])
        self.legend.setdefault(
            text, (box if fill else "") + "".join(map_symbols.line(symbol, row, False, 1.0))
        )

    def point(
        self,
        name: str,
        latitude: float,
        longitude: float,
        text: str,
        label: Sequence[str] = (),
        burned: bool = False,
    ) -> None:
        """Draw a symbol, and its label (lines of text) if there is space."""
        x, y = (float(each) for each in self.frame.place(latitude, longitude))
        if not self.frame.contains(x, y) or (name == "Named place" and self._is_station(x, y, label)):
            return
        radius = (1.5 if name != "Named place" else 1.2) * self.unit
        drawn = map_symbols.point(name, x, y, radius)
        key = map_symbols.point(name, 0.0, 0.0, 1.6 if name != "Named place" else 1.3)
        if burned:
            drawn, key = (each.replace('fill="#fff"', f'fill="{BURNED}"', 1) for each in (drawn, key))
        self.points.append(drawn)
        self.legend.setdefault(text, key)
        self.taken.append((x - radius, y - radius, x + radius, y + radius))
        if name == "Station":
            self.stations.append((x, y, label[0]))
        lines = [each for each in label if each]
        if not self.label(x, y, radius, lines):
            self.label(x, y, radius, lines[:1])

    def _is_station(self, x: float, y: float, label: Sequence[str]) -> bool:
        """Check whether a station with the name of this place in its own covers it: Exercise base Camino."""
        return any(
            abs(x - east) + abs(y - south) < self.unit and name.endswith(label[0])
            for east, south, name in self.stations
        )

    def label(self, x: float, y: float, radius: float, lines: Sequence[str]) -> bool:
        """Write a label near a point, at the first place that is free; True if there is one."""
        if not lines:
            return False
        size = 2.5 * self.unit
        wide = 0.6 * size * max(len(lines[0]), *(0.8 * len(each) for each in lines))
        high, away = size * 1.15 * len(lines), radius + 0.6
        level = y - 0.6 * size
        for anchor, left, top in (
            ("start", x + away, level),
            ("end", x - away - wide, level),
            ("start", x + away, level - 0.8 * high),
            ("start", x + away, level + 0.8 * high),
            ("end", x - away - wide, level - 0.8 * high),
            ("end", x - away - wide, level + 0.8 * high),
            ("middle", x - 0.5 * wide, y - radius - 0.2 - high),
            ("middle", x - 0.5 * wide, y + radius + 0.2),
        ):
            box = (left, top, left + wide, top + high)
            inside = self.frame.contains(left, top, 0.5) and self.frame.contains(left + wide, top + high, 0.5)
            if inside and not any(overlap(box, other) for other in self.taken):
                self.taken.append(box)
                at = left + {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor] * wide
                self.labels += _texts(lines, at, top, size, anchor)
                return True
        return False


OUTSIDE = "Outside the run: no data"
"""Text of the legend for the hatching."""
_ROUTE = "Resource, number as in the table Divisions"
BURNED = "#ff9d8a"
"""Fill of a point that has burned by the end of the run."""


def draw(briefing: Briefing, frame: MapFrame, unit: float) -> Content:
    """Draw context, fronts, stations and places, lowest first."""
    content = Content(frame, unit)
    if base_map.reaches_outside(briefing.run, frame):
        content.legend[OUTSIDE] = _outside_key()
    for each in briefing.context:
        _outlines(content, each)
    _fronts(content, briefing)
    for each in briefing.context:
        _symbols(content, each)
    _places(content, briefing)
    for each in briefing.context:
        line_labels.write(content, each)
    return content


def _outside_key() -> str:
    lines = "".join(f"M{x:g},1.4l2.8,-2.8" for x in np.arange(-4.0, 1.5, 1.3))
    return (
        f'<rect x="-4" y="-1.4" width="8" height="2.8" fill="{base_map.OUTSIDE}" stroke="#888" '
        f'stroke-width="0.15"/><path d="{lines}" stroke="{base_map.OUTSIDE_LINE}" stroke-width="0.3"/>'
    )


def regular(fronts: Sequence[Front], zone: str) -> tuple[list[Front], int]:
    """Choose fronts at full local hours before the last front, and their interval, h."""
    local = [(front, front.utc.astimezone(ZoneInfo(zone))) for front in fronts[:-1]]
    for hours in _HOURS:
        chosen = [
            front
            for front, when in local
            if when.minute == when.second == 0 and (when.toordinal() * 24 + when.hour) % hours == 0
        ]
        if len(chosen) <= _MOST_FRONTS:
            return chosen, hours
    return [], _HOURS[-1]


def _fronts(content: Content, briefing: Briefing) -> None:
    earlier, hours = regular(briefing.fronts, briefing.zone)
    for front in earlier:
        for line in front.lines:
            if _size(line) < _LEAST * content.frame.metres:
                continue
            content.line("Fire Edge Earlier", line, True, f"Simulated fire edge every {hours} h before")
    if briefing.observed:
        last = briefing.observed[-1]
        text = f"Observed perimeter, {times.text(last.time, briefing.zone)}"
        for polygon in last.polygons:
            for ring in polygon:
                content.line("Observed Perimeter", np.asarray(ring, np.float64), True, text)
    least = _LEAST * content.frame.metres
    kept = [line for line in briefing.fronts[-1].lines if _size(line) >= least]
    outer = np.sign(_area(max(kept, key=_size))) if kept else 1.0
    edges = [line for line in kept if np.sign(_area(line)) == outer]
    islands = [line for line in kept if np.sign(_area(line)) != outer]
    for line in islands:
        content.line(
            "Unburned Island", line, True, f"Unburned island, over {units.distance(least, briefing.units)}"
        )
    for line in edges:
        content.line("Fire Edge", line, True, f"Simulated fire edge, {briefing.moments[-1]}")


def _size(line: Array) -> float:
    """Compute the longer side of the box of a line, m."""
    scale = metres_per_degree(float(line[0, 1]))
    return float(max(np.ptp(line[:, 1]) * scale[0], np.ptp(line[:, 0]) * scale[1]))


def _area(line: Array) -> float:
    """Compute the signed area of a closed line: islands have the opposite sign of the outer edge."""
    x, y = (line - line[0]).T
    return float(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1]))


def _outlines(content: Content, each: Context) -> None:
    for feature in each.features:
        style = context.line_style(each, feature)
        text = _ROUTE if context.NUMBER in feature.properties else context.style_title(each, style)
        for line in feature.lines:
            if len(line) > 1:
                content.line(style, line, False, text)
        for polygon in feature.polygons:
            for number, ring in enumerate(polygon):
                content.line(style, ring, True, text, 0.0 if number else fill(style))


def fill(style: str) -> float:
    """Return the opacity of the area inside an outline."""
    return _ZONE_OPACITY if style in ("zones", "water", "values") else 0.0


def _symbols(content: Content, each: Context) -> None:
    """Draw points, and labels of zones at the middle of their box."""
    for feature in each.features:
        name, label = context.point_symbol(each, feature), context.label(feature)
        for longitude, latitude in feature.points:
            content.point(name, latitude, longitude, context.style_title(each, name), [label])
        if each.name == "zones" and label and feature.polygons:
            ring = feature.polygons[0][0]
            x, y = (
                float(at) for at in content.frame.place(*(0.5 * (ring.min(axis=0) + ring.max(axis=0)))[::-1])
            )
            if content.frame.contains(x, y):
                content.label(x, y, 0.0, [label])


def _places(made: Content, briefing: Briefing) -> None:
    for point in sorted(briefing.points, key=lambda each: each.station is None):
        burned = point.reached.state in ("before", "reached")
        name = "Named place" if point.station is None else "Station"
        text = f"{name}, burned by the end" if burned else name
        made.point(
            name, point.latitude, point.longitude, text, [point.name, point.reached.text.headline], burned
        )


def _thinned(points: Array) -> Array:
    """Remove points that are closer than `_NEAR` to the point before."""
    kept, last = [0], points[0]
    for index in range(1, len(points)):
        if abs(points[index, 0] - last[0]) + abs(points[index, 1] - last[1]) >= _NEAR:
            kept.append(index)
            last = points[index]
    return points[kept]


def _texts(lines: Sequence[str], x: float, top: float, size: float, anchor: str) -> Iterator[str]:
    for number, text in enumerate(lines):
        letters = size if number == 0 else 0.8 * size
        weight = ' font-weight="600"' if number == 0 else ""
        y = top + size * (0.85 + 1.0 * number)
        at = f'x="{x:.2f}" y="{y:.2f}" font-size="{letters:.2f}" text-anchor="{anchor}"{weight}'
        yield f'<text {at} {map_symbols.HALO} aria-hidden="true">{quote(text)}</text>'
        yield f"<text {at}>{quote(text)}</text>"
