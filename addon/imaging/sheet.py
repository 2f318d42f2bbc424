"""Panel sheet: four panels and a column of facts, drawn by matplotlib in its default typeface.

Lengths are in units of a hundredth of the picture's height (at 16:9), so a sheet looks the same in any size.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib
import numpy as np
from firetwin_core import sensor
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.text import Text
from numpy.typing import NDArray

from . import colour_bar

PAPER, INK, QUIET = "#14171b", "#f2f3f4", "#9aa3ad"
NEAREST, FARTHEST = 50.0, 50_000.0  # m, ends of the depth scale
_SIDE, _GAP, _BAR = 30.5, 1.5, 1.6  # margin at the sides, gap between panels, colour bar
_COLUMN = 17.5  # width of the fact column at the right
_DPI = 100.0
Part = tuple[float, float]  # fraction of the view, across and up, around its centre
WHOLE: Part = (1.0, 1.0)
_DEPTHS = matplotlib.colormaps["viridis_r"]


class Sheet:
    """Sheet of `width` by `height` pixels; panels 0 and 1 are above, 2 and 3 below.

    Parameters
    ----------
    foot
        Rows along its bottom that stay empty.
    """

    def __init__(self, width: int, height: int, foot: int = 0) -> None:
        self.width, self.height = width, height
        self.unit = min(width / 178.0, height / 100.0)
        self.shadow: list[AbstractPathEffect] = [
            withStroke(linewidth=0.5 * self.points(1.0), foreground="#000000b0")
        ]
        across = (width / self.unit - _SIDE - 3.0 * _GAP) / 2.0
        tall = (height - foot) / self.unit
        up = (tall - 8.0 - 3.0 * _GAP) / 2.0
        self.wide = min(across, up * width / height)
        self.high = self.wide * height / width
        self.top = tall - 2.0 * (self.high + _GAP)
        self.figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI, facecolor=PAPER)
        self.canvas = FigureCanvasAgg(self.figure)

    def head(self, title: str, facts: list[tuple[str, list[str]]]) -> None:
        """Draw title and time at the top, and the other facts at the right."""
        (_, (local, utc)), *others = facts
        middle, right = 0.5 * self.top, self.width / self.unit - _GAP
        clock = [
            self.text(right, middle - 0.3, local, 3.4, ha="right", va="bottom", weight="bold"),
            self.text(right, middle + 0.3, utc, 2.3, QUIET, ha="right", va="top"),
        ]
        room = right - max(map(self.length, clock)) - 2.0 * _GAP
        self.fit(self.text(_GAP, middle, title, 3.0, va="center", weight="bold"), room)
        at = right - _COLUMN
        down = self.top
        for name, lines in others:
            self.text(at, down, name, 1.9, QUIET, va="top")
            down += 2.7
            for line in lines:
                weight = "bold" if line is lines[0] else "normal"
                self.fit(self.text(at, down, line, 2.3, va="top", weight=weight), _COLUMN)
                down += 3.4
            down += 2.6

    def panel(self, place: int, name: str) -> Axes:
        """Create the empty axes of a panel, labelled in its corner."""
        row, column = divmod(place, 2)
        x, y = _GAP + column * (self.wide + _GAP), self.top + row * (self.high + _GAP)
        axes = self._axes(x, y, self.wide, self.high)
        axes.set_axis_off()
        label = self.text(x + 1.0, y + 0.9, name, 2.1, va="top", weight="bold", zorder=20)
        label.set_path_effects(self.shadow)
        return axes

    def picture(
        self,
        place: int,
        name: str,
        pixels: NDArray,
        part: Part = WHOLE,
        outlined: Mapping[Part, str] | None = None,
    ) -> None:
        """Draw pixels (h, w, 3), 0..1, of a part of the view; smaller parts are outlined and labelled."""
        axes = self.panel(place, name)
        wide, high = part
        axes.imshow(
            np.clip(pixels, 0.0, 1.0),
            extent=(-wide, wide, -high, high),
            aspect="auto",
            interpolation_stage="rgba",
        )
        axes.set_xlim(-1.0, 1.0)
        axes.set_ylim(-1.0, 1.0)
        for (wide, high), what in (outlined or {}).items():
            if min(wide, high) < 1.0:
                corner, line = (-wide, -high), self.points(0.25)
                axes.add_patch(
                    Rectangle(corner, 2.0 * wide, 2.0 * high, fill=False, edgecolor=INK, linewidth=line)
                )
                said: dict[str, Any] = {
                    "size": self.points(1.5),
                    "family": "DejaVu Sans",
                    "color": INK,
                    "va": "bottom",
                }
                axes.text(0.015 - wide, 0.02 - high, what, path_effects=self.shadow, **said)

    def thermal(
        self,
        place: int,
        kelvin: NDArray,
        low: float,
        high: float,
        palette: str,
        knee: float,
        cold: float,
        part: Part = WHOLE,
    ) -> None:
        """Draw brightness temperatures (h, w), K, and their bar, as `colour_bar.paint` does."""
        self.picture(place, "THERMAL", colour_bar.paint(kelvin, low, high, palette, knee, cold), part)
        bar = sensor.colour(np.linspace(1.0, 0.0, 256)[:, None], 0.0, 1.0, palette)
        marks = colour_bar.choose_ticks(low, high, knee, 0.5 * self.high / 2.0, cold)
        self._scale(
            place,
            bar,
            [
                (f"{mark:.0f}", float(colour_bar.scale_position(mark, low, high, knee, cold)))
                for mark in marks
            ],
            "K",
        )

    def depth(self, place: int, metres: NDArray, sky: float, part: Part = WHOLE) -> None:
        """Draw depth (h, w), m, and its bar, on a logarithmic scale; the sky has no colour."""
        share = np.log(np.maximum(metres, 1.0e-3) / NEAREST) / np.log(FARTHEST / NEAREST)
        shown = _DEPTHS(np.clip(share, 0.0, 1.0))[..., :3]
        shown[metres > sky] = 0.16
        self.picture(place, "DEPTH", shown, part)
        marks = [step * 10.0**power for power in range(1, 5) for step in (1, 2, 5)]
        ticks = [mark for mark in marks if NEAREST <= mark <= FARTHEST]
        places = [np.log(mark / NEAREST) / np.log(FARTHEST / NEAREST) for mark in ticks]
        names = [f"{mark:g} m" if mark < 1000.0 else f"{mark / 1e3:g} km" for mark in ticks]
        bar = _DEPTHS(np.linspace(1.0, 0.0, 256))[:, None, :3]
        self._scale(place, bar, list(zip(names, places, strict=True)), "")

    def text(self, x: float, y: float, text: str, size: float, colour: str = INK, **more: Any) -> Text:
        """Draw text at (x, y) units from the upper left corner, `size` units high."""
        at = x * self.unit / self.width, 1.0 - y * self.unit / self.height
        return self.figure.text(*at, text, size=self.points(size), color=colour, family="DejaVu Sans", **more)

    def length(self, text: Text) -> float:
        """Measure the width of a text, units."""
        return text.get_window_extent(self.canvas.get_renderer()).width / self.unit

    def fit(self, text: Text, room: float) -> None:
        """Shrink a text that is wider than `room`, units."""
        wide = self.length(text)
        if wide > room:
            text.set_fontsize(float(text.get_fontsize()) * room / wide)

    def points(self, units: float) -> float:
        """Convert units to typographic points."""
        return units * self.unit * 72.0 / _DPI

    def pixels(self) -> NDArray[np.float32]:
        """Render the sheet to pixels (h, w, 3), 0..1."""
        self.canvas.draw()
        return np.asarray(self.canvas.buffer_rgba())[..., :3].astype(np.float32) / 255.0

    def _axes(self, x: float, y: float, wide: float, high: float) -> Axes:
        u, v = self.unit / self.width, self.unit / self.height
        return self.figure.add_axes((x * u, 1.0 - (y + high) * v, wide * u, high * v))

    def _scale(self, place: int, bar: NDArray, marks: list[tuple[str, float]], unit: str) -> None:
        """Draw a colour bar to the right of a panel of the right column."""
        x, y = 2.0 * (self.wide + _GAP) + 0.8, self.top + (place // 2) * (self.high + _GAP)
        first, high = y + (3.0 if unit else 0.0), self.high - (3.0 if unit else 0.0)
        axes = self._axes(x, first, _BAR, high)
        axes.imshow(bar, aspect="auto", extent=(0.0, 1.0, 0.0, 1.0))
        axes.set_axis_off()
        if unit:
            self.text(x, y, unit, 1.9, QUIET, va="top")
        for name, share in marks:
            at = first + high * (1.0 - share)
            self.text(x + _BAR + 0.6, min(max(at, first + 0.8), first + high - 0.8), name, 1.8, va="center")
