"""Texts around the map: title, legend, scale, north arrow, datum and sources."""

from __future__ import annotations

from dataclasses import dataclass

from ..html_text import quote
from . import base_map, graticule
from .briefing import Briefing
from .sheet_map import Content
from .sheet_options import SheetOptions, Titles
from .sheet_text import Column
from .units import MILE

_BAR = 0.72  # most of the width of a column
_LENGTHS = (0.1, 0.2, 0.5, 1.0, 2.0, 4.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0)


@dataclass(frozen=True)
class Margin:
    """Writer of the columns next to or below a map."""

    briefing: Briefing
    options: SheetOptions
    titles: Titles
    content: Content

    def all(self, width: float, unit: float) -> Column:
        """Write everything in one column."""
        column = Column(width, unit)
        self._title(column)
        self._legend(column)
        self._arrival(column)
        self._scale(column)
        self._source(column)
        return column

    def three(self, width: float, unit: float) -> list[Column]:
        """Write three columns: title, legend, and scale with sources."""
        columns = [Column(width, unit) for _ in range(3)]
        self._title(columns[0])
        self._legend(columns[1])
        self._arrival(columns[2])
        self._scale(columns[2])
        self._source(columns[0])
        return columns

    def _title(self, column: Column) -> None:
        for word, text in self.briefing.warnings:
            column.text(word, 4.6, bold=True, colour="#b00020")
            column.text(text, 2.3, colour="#b00020")
            column.gap(0.8)
        titles = self.titles
        column.text(titles.incident, 4.4, bold=True)
        column.text("Fire arrival map", 3.0)
        column.gap()
        column.pair("Operational period", titles.period)
        column.pair("Prepared", titles.prepared)
        column.pair("Author", titles.author)
        column.pair("Model issued", f"{titles.issued}; age when prepared: {titles.age}")

    def _legend(self, column: Column) -> None:
        column.heading("Legend")
        for text, drawing in reversed(self.content.legend.items()):
            column.row(drawing, text)

    def _arrival(self, column: Column) -> None:
        """Write the colours of arrival times, a part of the legend."""
        legend = next((layer.legend for layer in self.briefing.layers if layer.name == "arrival"), None)
        if legend is None:
            return
        column.text(legend.title, 2.3)
        colours, unit = base_map.colours(), column.unit
        step = column.width / len(colours)
        boxes = "".join(
            f'<rect x="{k * step:.2f}" width="{step + 0.05:.2f}" height="{3.0 * unit:.2f}" fill="{colour}"/>'
            for k, colour in enumerate(colours)
        )
        anchors = ("start", "middle", "end")
        ticks = "".join(
            f'<text x="{at * column.width:.2f}" y="{5.3 * unit:.2f}" font-size="{1.9 * unit:.2f}" '
            f'text-anchor="{anchor}">{quote(text)}</text>'
            for (at, text), anchor in zip(legend.ticks, anchors, strict=False)
        )
        column.gap(0.5)
        column.drawing(boxes + ticks, 6.0 * unit)
        for colour, text in legend.notes:
            mixed = base_map.mixed(colour)
            column.row(f'<rect x="-4" y="-1.4" width="8" height="2.8" fill="{mixed}"/>', text)

    def _scale(self, column: Column) -> None:
        frame = self.content.frame
        column.heading(f"Scale 1:{frame.ratio:,.0f}")
        us = (MILE, "mi", f"1 in = {frame.ratio * 0.0254 / MILE:.2f} mi")
        metric = (1000.0, "km", f"1 cm = {frame.ratio / 1e5:.2f} km")
        for metres, name, words in (us, metric) if self.options.units == "us" else (metric, us):
            self._bar(column, metres, name)
            column.text(words, 2.0)
        column.gap(1.0)
        self._north(column)
        zone = frame.zone
        column.text(f"Datum WGS 84; projection UTM zone {zone.name} (EPSG:{zone.epsg})", 2.2)
        if self.options.grid == "usng":
            names = ", ".join(graticule.squares(frame))
            column.text(f"US National Grid (USNG/MGRS) {graticule.interval(frame, 'usng')}: {names}", 2.2)
        elif self.options.grid == "latlong":
            column.text(f"Graticule {graticule.interval(frame, 'latlong')}", 2.2)

    def _bar(self, column: Column, metres: float, name: str) -> None:
        frame, unit = self.content.frame, column.unit
        most = _BAR * column.width * frame.metres / metres
        length = max((each for each in _LENGTHS if each <= most), default=_LENGTHS[0])
        wide, high = length * metres / frame.metres, 1.4 * unit
        boxes = "".join(
            f'<rect x="{k * wide / 4:.3f}" y="{2.9 * unit:.2f}" width="{wide / 4:.3f}" height="{high:.2f}" '
            f'fill="{"#000" if k % 2 == 0 else "#fff"}" stroke="#000" stroke-width="0.15"/>'
            for k in range(4)
        )
        texts = "".join(
            f'<text x="{share * wide:.2f}" y="{2.3 * unit:.2f}" font-size="{2.0 * unit:.2f}" '
            f'text-anchor="{anchor}">{share * length:g}{ending}</text>'
            for share, anchor, ending in (
                (0.0, "start", ""),
                (0.5, "middle", ""),
                (1.0, "middle", f" {name}"),
            )
        )
        column.drawing(
            f'<g class="scale-bar" data-metres="{length * metres:g}">{boxes}{texts}</g>', 4.8 * unit
        )

    def _north(self, column: Column) -> None:
        """Draw an arrow to grid north, and a thin line to true north."""
        angle, unit = self.content.frame.zone.convergence(*self.content.frame.middle), column.unit
        arrow = (
            f'<g class="north" transform="translate({5 * unit:.2f} {8.5 * unit:.2f}) scale({unit:.3f})">'
            '<path d="M0,-5L1.8,3L0,1.6L-1.8,3Z" fill="#000"/>'
            '<text y="-5.6" font-size="3" font-weight="700" text-anchor="middle">N</text>'
            f'<path d="M0,3V-6" stroke="#b00020" stroke-width="0.2" transform="rotate({-angle:.2f} 0 3)"/>'
            "</g>"
        )
        side = "east" if angle >= 0.0 else "west"
        lines = ("Grid north is up.", f"It is {abs(angle):.1f}° {side}", "of true north (red).")
        texts = "".join(
            f'<text x="{11 * unit:.2f}" y="{(4 + 3 * k) * unit:.2f}" '
            f'font-size="{2.2 * unit:.2f}">{line}</text>'
            for k, line in enumerate(lines)
        )
        column.drawing(arrow + texts, 13.0 * unit)

    def _source(self, column: Column) -> None:
        column.heading("Source")
        for text in self.briefing.short_sources:
            column.text(text, 2.1)
