"""Pictures of several runs in one: where each stands, its name, a thin line between, and the time."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

_DPI = 100.0
_EMPTY = 0.07  # of a quarter without a picture
_EDGE = "#000000c0"
Key = tuple[str, str]
"""A colour and what it stands for."""


def sheet(pictures: list[NDArray], keys: list[list[Key]], foot: list[str]) -> NDArray[np.float32]:
    """One picture of as many pixels as each of `pictures` (h, w, 3), of which there are one to four.

    Two share it as halves, each with the middle of its picture; of three or four each has a quarter, all of
    it half as large. `keys` stand in their upper left corners, `foot` line by line in the lower left one.
    """
    height, width = pictures[0].shape[:2]
    sheet, corners = _arranged([np.clip(each[..., :3], 0.0, 1.0) for each in pictures])
    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI)
    canvas = FigureCanvasAgg(figure)
    figure.figimage(np.round(255.0 * sheet[::-1]).astype(np.uint8), origin="lower")
    unit = height / 100.0
    large = unit if len(corners) < 3 else 0.8 * unit
    for (left, top), listed in zip(corners, keys, strict=True):
        for number, (colour, text) in enumerate(listed):
            at = top + (2.5 + 5.2 * number) * large
            box = (left + 2.0 * unit) / width, 1.0 - (at + 3.0 * large) / height
            shape = Rectangle(box, 3.0 * large / width, 3.0 * large / height, transform=figure.transFigure)
            shape.set(facecolor=colour, edgecolor=_EDGE, linewidth=0.1 * unit)
            figure.add_artist(shape)
            _text(figure, left + 2.0 * unit + 4.4 * large, at + 1.5 * large, text, 3.4 * large)
    for number, line in enumerate(reversed(foot)):
        _text(figure, 2.0 * unit, height - (3.2 + 4.6 * number) * unit, line, 3.0 * unit)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].astype(np.float32) / 255.0


def _arranged(pictures: list[NDArray]) -> tuple[NDArray, list[tuple[int, int]]]:
    """Pictures in their places with lines between, and the upper left corners (x, y) of these."""
    height, width = pictures[0].shape[:2]
    if len(pictures) == 1:
        return pictures[0], [(0, 0)]
    line = max(1, round(height / 360))
    half, across = width // 2, slice(width // 2 - line // 2 - line % 2, width // 2 + line // 2)
    if len(pictures) == 2:
        middle = slice(width // 4, width // 4 + half)
        sheet = np.concatenate([each[:, middle] for each in pictures], axis=1)
        sheet[:, across] = 1.0
        return sheet, [(0, 0), (half, 0)]
    sheet = np.full((height, width, 3), _EMPTY, np.float32)
    corners = [(0, 0), (half, 0), (0, height // 2), (half, height // 2)][: len(pictures)]
    for (x, y), each in zip(corners, pictures, strict=True):
        small = each.reshape(height // 2, 2, half, 2, 3).mean((1, 3))
        sheet[y : y + height // 2, x : x + half] = small
    sheet[:, across] = 1.0
    sheet[height // 2 - line // 2 - line % 2 : height // 2 + line // 2] = 1.0
    return sheet, corners


def _text(figure: Figure, x: float, y: float, text: str, size: float) -> None:
    """Text `size` pixels high whose middle is at y (pixels from above), beginning at x."""
    width, height = figure.get_size_inches() * _DPI
    said = figure.text(
        x / width, 1.0 - y / height, text, size=size * 72.0 / _DPI, color="white", family="DejaVu Sans",
        va="center",
    )  # fmt: skip
    said.set_path_effects([withStroke(linewidth=0.22 * size, foreground=_EDGE)])
