"""Paper of the printed page: sizes, margins, and style rules with a running header and footer."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import matplotlib
from PIL import ImageFont

Orientation = Literal["portrait", "landscape"]

SIZES = {"a4": (210.0, 297.0), "a3": (297.0, 420.0), "letter": (215.9, 279.4), "tabloid": (279.4, 431.8)}
"""Width and height in portrait, mm (ISO 216; ANSI/ASME Y14.1, where tabloid is 11 x 17 in)."""
SIDE, HEAD = 10.0, 13.0
"""Margins at the sides, and at the top and bottom, which hold the running header and footer, mm."""
_A4_AREA = 210.0 * 297.0
_POINTS = 6.5  # size of the running header and footer
_LETTER = _POINTS * 25.4 / 72.0  # mm
_LINES = 3  # most lines of a margin box; they are 7.9 mm high
_SHARE = {"left": 0.49, "right": 0.49, "center": 0.32}
"""Most width of a margin box as a share of the sheet; a side with three boxes has thirds."""


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
    width = paper.area[0]
    boxes = "".join(_box(name, text, width * _share(name, running)) for name, text in running.items())
    width, height = paper.area
    return (
        f"@page {{ size: {paper.width:g}mm {paper.height:g}mm; margin: {HEAD:g}mm {SIDE:g}mm;\n{boxes}"
        f'@bottom-right {{ content: "Page " counter(page) " of " counter(pages); {_BOX} }}\n}}\n'
        f"@media print {{ .map-sheet svg {{ width: {width:g}mm; height: {height - 0.5:g}mm; }} }}"
    )


_BOX = f'font: {_POINTS}pt/1.15 "DejaVu Sans", Arial, sans-serif; color: #000; white-space: pre;'


def _share(name: str, running: Mapping[str, str]) -> float:
    """Choose the share of a margin box so that the boxes of a side cannot overlap."""
    side, place = name.split("-")
    return _SHARE["center"] if f"{side}-center" in running else _SHARE[place]


def _box(name: str, text: str, width: float) -> str:
    return f"@{name} {{ content: {_string(chr(10).join(fit(text, width)))}; {_BOX} }}\n"


def fit(text: str, width: float) -> list[str]:
    """Wrap a text of the running header into lines of at most `width` mm; an ellipsis ends a longer one."""
    lines: list[str] = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if measure(longer) <= width:
            lines[-1] = longer
        else:
            lines += [word] if lines[-1] else []
            lines[-1] = word
    kept = lines[:_LINES]
    if len(lines) > _LINES:
        kept[-1] += "…"
    return [_shorten(line, width) for line in kept]


def measure(text: str) -> float:
    """Measure the width of a text of the running header, mm, in DejaVu Sans, which is wider than Arial."""
    return _font().getlength(text) / _MEASURED * _LETTER


def _shorten(line: str, width: float) -> str:
    if measure(line) <= width:
        return line
    short = line.removesuffix("…")
    while short and measure(f"{short}…") > width:
        short = short[:-1]
    return f"{short.rstrip()}…"


_MEASURED = 100  # pixels, size at which widths are measured


@functools.cache
def _font() -> ImageFont.FreeTypeFont:
    return ImageFont.truetype(Path(matplotlib.get_data_path(), "fonts/ttf/DejaVuSans.ttf"), _MEASURED)


def _string(text: str) -> str:
    """Quote text for CSS: all but ASCII letters, digits and spaces become escapes."""
    return (
        '"' + "".join(each if re.match("[A-Za-z0-9 ]", each) else f"\\{ord(each):x} " for each in text) + '"'
    )
