"""Split screen: pictures of several runs in one, with names, dividing lines and the time."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

_DPI = 100.0
_EMPTY = 0.07  # grey level of a quarter without a picture
_EDGE = "#000000c0"
HATCHED = "hatched"
Key = tuple[str, str]
"""Legend entry: a colour and its meaning; `HATCHED` in place of a colour; "" for a heading."""


def sheet(
    pictures: list[NDArray], keys: list[list[Key]], foot: list[str], below: int = 0
) -> NDArray[np.float32]:
    """Compose one to four `pictures` (h, w, 3) into one picture of the same size.

    Two are halves with the central half of their picture. Three or four are quarters with the whole picture
    at half size. `keys` are drawn in their upper left corners, the lines of `foot` in the lower left corner,
    `below` rows from the bottom.
    """
    height, width = pictures[0].shape[:2]
    sheet, corners = _arranged([np.clip(picture[..., :3], 0.0, 1.0) for picture in pictures])
    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI)
    canvas = FigureCanvasAgg(figure)
    figure.figimage(np.round(255.0 * sheet[::-1]).astype(np.uint8), origin="lower")
    unit = height / 100.0
    large = unit if len(corners) < 3 else 0.8 * unit
    for (left, top), listed in zip(corners, keys, strict=True):
        for number, (colour, text) in enumerate(listed):
            at = top + (2.5 + 5.2 * number) * large
            if colour:
                box = left + 2.0 * unit, at, 3.0 * large
                _swatch(figure, colour, box, unit)
            indent = 4.4 * large if colour else 0.0
            _text(figure, left + 2.0 * unit + indent, at + 1.5 * large, text, 3.4 * large)
    for number, line in enumerate(reversed(foot)):
        _text(figure, 2.0 * unit, height - below - (3.2 + 4.6 * number) * unit, line, 3.0 * unit)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].astype(np.float32) / 255.0


def _arranged(pictures: list[NDArray]) -> tuple[NDArray, list[tuple[int, int]]]:
    """Arrange pictures with dividing lines; also return their upper left corners (x, y)."""
    height, width = pictures[0].shape[:2]
    if len(pictures) == 1:
        return pictures[0], [(0, 0)]
    line = max(1, round(height / 360))
    half, across = width // 2, slice(width // 2 - line // 2 - line % 2, width // 2 + line // 2)
    if len(pictures) == 2:
        middle = slice(width // 4, width // 4 + half)
        sheet = np.concatenate([picture[:, middle] for picture in pictures], axis=1)
        sheet[:, across] = 1.0
        return sheet, [(0, 0), (half, 0)]
    sheet = np.full((height, width, 3), _EMPTY, np.float32)
    corners = [(0, 0), (half, 0), (0, height // 2), (half, height // 2)][: len(pictures)]
    for (x, y), place in zip(corners, pictures, strict=True):
        small = place.reshape(height // 2, 2, half, 2, 3).mean((1, 3))
        sheet[y : y + height // 2, x : x + half] = small
    sheet[:, across] = 1.0
    sheet[height // 2 - line // 2 - line % 2 : height // 2 + line // 2] = 1.0
    return sheet, corners


def _swatch(figure: Figure, colour: str, box: tuple[float, float, float], unit: float) -> None:
    """Draw the square of a legend entry: left and top side, and its size, pixels."""
    left, top, size = box
    width, height = figure.get_size_inches() * _DPI
    corner = left / width, 1.0 - (top + size) / height
    shape = Rectangle(corner, size / width, size / height, transform=figure.transFigure)
    if colour == HATCHED:
        shape.set(facecolor="#00000060", edgecolor="white", hatch="////", linewidth=0.1 * unit)
    else:
        shape.set(facecolor=colour, edgecolor=_EDGE, linewidth=0.1 * unit)
    figure.add_artist(shape)


def _text(figure: Figure, x: float, y: float, text: str, size: float) -> None:
    """Draw text `size` pixels high, vertically centred on y (pixels from the top), from x on."""
    width, height = figure.get_size_inches() * _DPI
    said = figure.text(
        x / width, 1.0 - y / height, text, size=size * 72.0 / _DPI, color="white", family="DejaVu Sans",
        va="center",
    )  # fmt: skip
    said.set_path_effects([withStroke(linewidth=0.22 * size, foreground=_EDGE)])
