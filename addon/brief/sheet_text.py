"""Columns of text, legend rows and drawings at the side of the map sheet."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass, field

from ..html_text import quote

FONT = '"DejaVu Sans", Arial, Helvetica, sans-serif'
_WIDE, _WIDE_BOLD = 0.58, 0.66  # mean width of a letter / font size
_LINE = 1.28  # distance of lines / font size


@dataclass
class Column:
    """Drawing that grows downwards from its origin.

    Attributes
    ----------
    width
        mm.
    unit
        Factor of all sizes.
    """

    width: float
    unit: float
    height: float = 0.0
    parts: list[str] = field(default_factory=list)

    def text(
        self, text: str, size: float = 2.5, bold: bool = False, colour: str = "#000", indent: float = 0.0
    ) -> None:
        """Add wrapped text."""
        size, indent = size * self.unit, indent * self.unit
        letters = max(int((self.width - indent) / (size * (_WIDE_BOLD if bold else _WIDE))), 4)
        weight = ' font-weight="700"' if bold else ""
        for line in textwrap.wrap(text, letters) or [""]:
            self.height += size * _LINE
            at = f'x="{indent:.2f}" y="{self.height - 0.3 * size:.2f}" font-size="{size:.2f}"'
            self.parts.append(f'<text {at} fill="{colour}"{weight}>{quote(line)}</text>')

    def pair(self, name: str, text: str) -> None:
        """Add a named value: the name in small letters, the value below it."""
        self.text(name, 2.0, colour="#444")
        self.text(text)
        self.gap(0.6)

    def gap(self, size: float = 1.5) -> None:
        """Add empty space, mm times the unit."""
        self.height += size * self.unit

    def heading(self, text: str) -> None:
        """Add a heading with a line above it."""
        self.gap(1.0)
        self.parts.append(
            f'<path d="M0,{self.height:.2f}H{self.width:.2f}" stroke="#000" stroke-width="0.25"/>'
        )
        self.gap(0.4)
        self.text(text, 2.8, bold=True)

    def row(self, drawing: str, text: str) -> None:
        """Add a row of the legend: a drawing around the origin, in a box of 9 x 4 mm, and its text."""
        top = self.height
        self.text(text, 2.3, indent=11.0)
        self.height = max(self.height, top + 4.2 * self.unit)
        at = f"translate({4.5 * self.unit:.2f} {top + 2.1 * self.unit:.2f}) scale({self.unit:.3f})"
        self.parts.append(f'<g transform="{at}">{drawing}</g>')

    def drawing(self, svg: str, height: float) -> None:
        """Add a drawing from the current position downwards, with coordinates in mm."""
        self.parts.append(f'<g transform="translate(0 {self.height:.2f})">{svg}</g>')
        self.height += height

    def svg(self, x: float, y: float) -> str:
        """Place the column on the sheet, mm."""
        return f'<g transform="translate({x:.2f} {y:.2f})">{"".join(self.parts)}</g>'
