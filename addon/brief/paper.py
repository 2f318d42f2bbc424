"""Paper of the printed page: sizes, margins, and style rules with a running header and footer."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Orientation = Literal["portrait", "landscape"]

SIZES = {"a4": (210.0, 297.0), "a3": (297.0, 420.0), "letter": (215.9, 279.4), "tabloid": (279.4, 431.8)}
"""Width and height in portrait, mm (ISO 216; ANSI/ASME Y14.1, where tabloid is 11 x 17 in)."""
SIDE, HEAD = 10.0, 13.0
"""Margins at the sides, and at the top and bottom, which hold the running header and footer, mm."""
_A4_AREA = 210.0 * 297.0


@dataclass(frozen=True)
class Paper:
    """A sheet of paper: width and height, mm."""

    width: float
    height: float

    @classmethod
    def named(cls, size: str, orientation: Orientation) -> Paper:
        """Look up a size of `SIZES` in an orientation."""
        short, long = SIZES[size]
        return cls(long, short) if orientation == "landscape" else cls(short, long)

    @property
    def area(self) -> tuple[float, float]:
        """Width and height within the margins, mm."""
        return self.width - 2.0 * SIDE, self.height - 2.0 * HEAD

    @property
    def text_scale(self) -> float:
        """Size of texts relative to A4: larger sheets are read from farther away."""
        return max(1.0, (self.width * self.height / _A4_AREA) ** 0.35)


def style(paper: Paper, running: Mapping[str, str]) -> str:
    """Build the rules of `@page`.

    Parameters
    ----------
    running
        Text of each margin box, such as "top-left". Page numbers are at the bottom right.
    """
    boxes = "".join(f"@{name} {{ content: {_string(text)}; {_BOX} }}\n" for name, text in running.items())
    width, height = paper.area
    return (
        f"@page {{ size: {paper.width:g}mm {paper.height:g}mm; margin: {HEAD:g}mm {SIDE:g}mm;\n{boxes}"
        f'@bottom-right {{ content: "Page " counter(page) " of " counter(pages); {_BOX} }}\n}}\n'
        f"@media print {{ .map-sheet svg {{ width: {width:g}mm; height: {height - 0.5:g}mm; }} }}"
    )


_BOX = 'font: 6.5pt "DejaVu Sans", Arial, sans-serif; color: #000; white-space: pre;'


def _string(text: str) -> str:
    """Quote text for CSS: all but ASCII letters, digits and spaces become escapes."""
    return (
        '"' + "".join(each if re.match("[A-Za-z0-9 ]", each) else f"\\{ord(each):x} " for each in text) + '"'
    )
