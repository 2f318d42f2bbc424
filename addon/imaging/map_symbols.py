"""Vector drawings of the symbols of NWCG's map standard.

Shapes and colours follow the descriptions in NWCG PMS 936, "Symbology" (public domain): for example, "red X
in red circle" for the fire origin. Other points, such as bases and stations, have the letters that are usual
in the Incident Command System.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_RED, _BLUE, _PURPLE, _GREEN = "#d40000", "#0b3fa8", "#7a1fa2", "#15803d"
FIRE_EDGE = _RED
"""Colour of the fire's edge."""
HALO = 'fill="none" stroke="#fff" stroke-width="0.8" stroke-linejoin="round"'
"""Attributes of a white text below a text on the map; not every printer knows `paint-order`."""


def _circle(fill: str, stroke: str, inside: str = "") -> str:
    return f'<circle r="0.92" fill="{fill}" stroke="{stroke}" stroke-width="0.22"/>{inside}'


def _square(fill: str, inside: str = "", stroke: str = "#fff") -> str:
    box = 'x="-0.9" y="-0.9" width="1.8" height="1.8"'
    return f'<rect {box} fill="{fill}" stroke="{stroke}" stroke-width="0.12"/>{inside}'


def _path(data: str, colour: str, width: float = 0.26) -> str:
    return f'<path d="{data}" fill="none" stroke="{colour}" stroke-width="{width}"/>'


def _letter(text: str, colour: str) -> str:
    size = 1.3 if len(text) == 1 else 0.9
    return (
        f'<text y="{0.36 * size:.2f}" font-size="{size}" font-weight="700" text-anchor="middle" '
        f'fill="{colour}">{text}</text>'
    )


_CROSS = "M-0.55,-0.55L0.55,0.55M-0.55,0.55L0.55,-0.55"

POINTS = {
    "Fire Origin": _circle("#fff", _RED, _path(_CROSS, _RED)),
    "Spot Fire": f'<circle r="0.55" fill="{_RED}" stroke="#fff" stroke-width="0.12"/>',
    "Division Break": _path("M-0.75,-0.9Q-0.05,0 -0.75,0.9M0.75,-0.9Q0.05,0 0.75,0.9", "#000", 0.3),
    "Branch Break": _path("M-0.8,-0.9H-0.25V0.9H-0.8M0.8,-0.9H0.25V0.9H0.8", "#000", 0.3),
    "Drop Point": _square(_BLUE),
    "Camp": _square(_BLUE, _path("M-0.6,0.55L0,-0.6L0.6,0.55M-0.2,0.55L0,0.15L0.2,0.55", "#fff", 0.2)),
    "Closure": _square(_BLUE, _path(_CROSS, "#fff")),
    "Airport": _circle(
        "#fff",
        _PURPLE,
        f'<path d="M0,-0.7L0.14,-0.2L0.65,0.15V0.32L0.14,0.18L0.1,0.5L0.28,0.66H-0.28L-0.1,0.5L-0.14,0.18'
        f'L-0.65,0.32V0.15L-0.14,-0.2Z" fill="{_PURPLE}"/>',
    ),
    "Aviation Check Point": _circle("#fff", _PURPLE, _path("M-0.5,0L-0.12,0.42L0.52,-0.45", _PURPLE)),
    "Aerial Hazard": _circle(
        "#fff",
        _PURPLE,
        _path("M-0.5,0.5L0,-0.5L0.5,0.5", _PURPLE) + f'<circle cy="0.3" r="0.17" fill="{_RED}"/>',
    ),
    "Dip Site": _circle(
        "#fff",
        _PURPLE,
        _path("M-0.6,-0.15Q-0.3,-0.45 0,-0.15T0.6,-0.15M-0.6,0.25Q-0.3,-0.05 0,0.25T0.6,0.25", _BLUE, 0.2),
    ),
    "Incident Command Post": _square("#fff", f'<path d="M-0.9,-0.9V0.9H0.9Z" fill="{_BLUE}"/>', _BLUE),
    "Incident Base": _circle("#fff", _BLUE, _letter("B", _BLUE)),
    "Staging Area": _circle("#fff", _BLUE, _letter("S", _BLUE)),
    "Water Source": _circle("#fff", _BLUE, _letter("W", _BLUE)),
    "Helibase": _circle("#fff", _PURPLE, _letter("H", _PURPLE)),
    "Helispot": f'<circle r="0.75" fill="{_PURPLE}" stroke="#fff" stroke-width="0.12"/>'
    + _letter("H", "#fff"),
    "Safety Zone": _circle("#fff", _GREEN, _letter("SZ", _GREEN)),
    "Lookout": _circle("#fff", _GREEN, _letter("L", _GREEN)),
    "Station": _square("#fff", _letter("F", "#000"), "#000"),
    "Named place": '<circle r="0.5" fill="#fff" stroke="#000" stroke-width="0.26"/>',
    "Value at risk": f'<path d="M0,-1L1,0L0,1L-1,0Z" fill="#fff" stroke="{_PURPLE}" stroke-width="0.24"/>',
}
"""Drawings of points, in a box from -1 to 1."""


@dataclass(frozen=True)
class LineStyle:
    """Style of a line: colour, width (mm), dashes (mm), and a mark that repeats along it.

    Attributes
    ----------
    mark
        "X" for crosses, "tick" for ticks, a letter, or none.
    casing
        True for a white edge, which separates the line from the colours below.
    """

    colour: str
    width: float = 0.5
    dashes: str = ""
    mark: str = ""
    casing: bool = True


LINES = {
    "Fire Edge": LineStyle(FIRE_EDGE, 0.9),
    "Fire Edge Earlier": LineStyle(FIRE_EDGE, 0.3, casing=False),
    "Unburned Island": LineStyle(FIRE_EDGE, 0.3, "1 0.6", casing=False),
    "Observed Perimeter": LineStyle("#0b4fa8", 0.6, "3 2"),
    "Contained Line": LineStyle("#000", 0.9),
    "Completed Line": LineStyle("#000", 0.9),
    "Completed Dozer Line": LineStyle("#000", 0.0, mark="X"),
    "Completed Hand Line": LineStyle("#000", 0.35, mark="H"),
    "Completed Plow Line": LineStyle("#000", 0.35, mark="P"),
    "Completed Mixed Construction Line": LineStyle("#000", 0.35, mark="M"),
    "Completed Road as Line": LineStyle("#000", 0.35, mark="R"),
    "Completed Burnout": LineStyle("#000", 0.4, mark="tick"),
    "Planned Line": LineStyle("#000", 0.6, "2.5 1.8"),
    "Line Not Held": LineStyle(_RED, 0.6, "0.8 1.2"),  # not of the standard
    "Escape Route": LineStyle(_GREEN, 0.6, "1 1"),
    "roads": LineStyle("#3b3b3b", 0.3, casing=False),
    "water": LineStyle("#1c6fb8", 0.35, casing=False),
    "boundaries": LineStyle("#4a4a4a", 0.35, "4 1 0.6 1", casing=False),
    "zones": LineStyle("#b45309", 0.6, "5 1.5"),
    "values": LineStyle(_PURPLE, 0.5),
    "other": LineStyle("#222", 0.4, casing=False),
}
"""Styles of lines and outlines: of the standard, then of context."""
_EVERY = 4.2  # mm between marks


def find(category: str, known: dict[str, LineStyle] | dict[str, str]) -> str:
    """Find the name of a symbol by a category of a file, without regard to case; empty if there is none."""
    wanted = " ".join(category.casefold().replace("_", " ").split())
    return next((name for name in known if name.casefold() == wanted), "")


def point(name: str, x: float, y: float, radius: float) -> str:
    """Draw a point symbol with a radius, mm."""
    return f'<g transform="translate({x:.2f} {y:.2f}) scale({radius:.2f})">{POINTS[name]}</g>'


def line(style: LineStyle, points: Array, closed: bool, scale: float) -> Iterator[str]:
    """Draw a line through points (n, 2), mm on the sheet; widths are multiplied by `scale`."""
    data = "M" + " ".join(f"{x:.2f},{y:.2f}" for x, y in points) + ("Z" if closed else "")
    rule = f'd="{data}" fill="none" stroke-linejoin="round"'
    width = style.width * scale
    if style.casing and width:
        yield f'<path {rule} stroke="#fff" stroke-width="{width + 0.5 * scale:.2f}" opacity="0.85"/>'
    if width:
        dashes = f' stroke-dasharray="{style.dashes}"' if style.dashes else ""
        yield f'<path {rule} stroke="{style.colour}" stroke-width="{width:.2f}"{dashes}/>'
    if style.mark:
        yield from _marks(style, points, scale)


def _marks(style: LineStyle, points: Array, scale: float) -> Iterator[str]:
    """Repeat the mark of a style along a line."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    every = (1.9 if style.mark == "X" else _EVERY) * scale
    for at in np.arange(0.5 * every, along[-1], every):
        k = min(int(np.searchsorted(along, at, side="right")) - 1, len(steps) - 1)
        share = (at - along[k]) / steps[k] if steps[k] else 0.0
        x, y = points[k] + share * (points[k + 1] - points[k])
        turn = np.degrees(np.arctan2(*(points[k + 1] - points[k])[::-1]))
        yield (
            f'<g transform="translate({x:.2f} {y:.2f}) rotate({turn:.0f}) scale({scale:.2f})">'
            f"{_mark(style)}</g>"
        )


def _mark(style: LineStyle) -> str:
    if style.mark == "X":
        return _path("M-0.9,-0.8L0.9,0.8M-0.9,0.8L0.9,-0.8", style.colour, 0.4)
    if style.mark == "tick":
        return _path("M0,0V-1.5", style.colour, 0.35)
    at = 'y="0.8" font-size="2.2" font-weight="700" text-anchor="middle"'
    halo = f'<text {at} {HALO} aria-hidden="true">{style.mark}</text>'
    return f'{halo}<text {at} fill="{style.colour}">{style.mark}</text>'
