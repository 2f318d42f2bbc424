"""Split screen: pictures of several runs in one, with names, dividing lines and the time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry.rectangles import overlap

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DPI = 100.0
_EMPTY = 0.07  # grey level of a quarter without a picture
_EDGE = "#000000c0"
HATCHED, LINE = "hatched", "line "
Key = tuple[str, str]
"""Legend entry: a colour and its meaning; "" for a heading. `HATCHED` replaces a colour, and `LINE` before
one means a line."""


class Mark(NamedTuple):
    """Text next to a place of a picture: pixels right and down, and the colour of a dot there.

    The text is at the right of the place, or at its left near the right edge of the picture.
    """

    x: float
    y: float
    text: str
    colour: str = "#ffffff"


def sheet(
    pictures: list[NDArray],
    keys: list[list[Key]],
    foot: list[str],
    below: int = 0,
    marks: Sequence[Sequence[Mark]] = (),
    corner: Sequence[str] = (),
) -> NDArray[np.float32]:
    """Compose one to four `pictures` (h, w, 3) into one picture of the same size.

    Two are halves with the central half of their picture. Three or four are quarters with the whole picture
    at half size. `keys` are drawn in their upper left corners, the lines of `foot` in the lower left corner,
    `below` rows from the bottom. `marks` are drawn in their pictures if they overlap neither other text nor
    an edge, the first ones first. The lines of `corner`, the first one larger, are drawn in the upper right.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = pictures[0].shape[:2]
    sheet, corners = _arranged([np.clip(picture[..., :3], 0.0, 1.0) for picture in pictures])
    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI)
    canvas = FigureCanvasAgg(figure)
    figure.figimage(np.round(255.0 * sheet[::-1]).astype(np.uint8), origin="lower")
    unit = height / 100.0
    large = unit if len(corners) < 3 else 0.8 * unit
    taken: list[Box] = []
    for (left, top), listed in zip(corners, keys, strict=True):
        for number, (colour, text) in enumerate(listed):
            at = top + (2.5 + 5.2 * number) * large
            taken.append(_box(left + 2.0 * unit, at + 1.5 * large, f"mm{text}", 3.4 * large))
            if colour:
                box = left + 2.0 * unit, at, 3.0 * large
                _swatch(figure, colour, box, unit)
            indent = 4.4 * large if colour else 0.0
            _text(figure, left + 2.0 * unit + indent, at + 1.5 * large, text, 3.4 * large)
    for number, line in enumerate(reversed(foot)):
        at = height - below - (3.2 + 4.6 * number) * unit
        _text(figure, 2.0 * unit, at, line, 3.0 * unit)
        taken.append(_box(2.0 * unit, at, line, 3.0 * unit))
    _write_corner(figure, corner, unit)
    for area, texts in zip(_areas(len(pictures), width, height), marks, strict=False):
        for mark, at_left in _free(texts, area, 2.8 * large, taken):
            _mark(figure, mark, 2.8 * large, at_left)
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


def _write_corner(figure: Figure, lines: Sequence[str], unit: float) -> None:
    """Write lines on a dark plate in the upper right corner, over other text of the picture."""
    from matplotlib.patches import Rectangle

    if not lines:
        return
    width, height = figure.get_size_inches() * _DPI
    sizes = [4.6, *[3.4] * (len(lines) - 1)]
    left = min(width - 0.62 * size * unit * len(line) for size, line in zip(sizes, lines, strict=True))
    left, bottom = left - 2.0 * unit, (5.6 * len(lines) + 3.0) * unit
    corner = left / width, 1.0 - bottom / height
    plate = Rectangle(corner, 1.0 - corner[0], (bottom - 2.4 * unit) / height, transform=figure.transFigure)
    plate.set(facecolor="#000000a0", linewidth=0.0)
    figure.add_artist(plate)
    for number, (size, line) in enumerate(zip(sizes, lines, strict=True)):
        _text(figure, width - 2.0 * unit, (6.0 + 5.6 * number) * unit, line, size * unit, "right")


Box = tuple[float, float, float, float]  # left, top, right, bottom, pixels


def _areas(pictures: int, width: int, height: int) -> list[tuple[Box, float, float]]:
    """Return the area of each picture on the sheet, its scale, and the first column that is shown."""
    if pictures < 3:
        part = width // pictures
        first = width // 4 if pictures == 2 else 0
        return [((part * k, 0, part * (k + 1), height), 1.0, first) for k in range(pictures)]
    half, middle = width // 2, height // 2
    return [((x, y, x + half, y + middle), 0.5, 0) for y in (0, middle) for x in (0, half)]


def _box(x: float, y: float, text: str, size: float) -> Box:
    """Estimate the box of a text `size` pixels high."""
    return x, y - 0.7 * size, x + 0.62 * size * len(text), y + 0.7 * size


def _free(
    marks: Sequence[Mark], area: tuple[Box, float, float], size: float, taken: list[Box]
) -> Iterator[tuple[Mark, bool]]:
    """Return the marks of a picture, on the sheet, that overlap no text and no edge.

    Their boxes are `taken` then. Also return True for a text at the left of its place.
    """
    (left, top, right, bottom), scale, first = area
    for mark in marks:
        x, y = left + scale * (mark.x - first), top + scale * mark.y
        long = 0.62 * size * (len(mark.text) + 1)
        for x0 in (x - 0.3 * size, x + 0.3 * size - long):
            box = x0, y - 0.7 * size, x0 + long, y + 0.7 * size
            inside = box[0] >= left and box[1] >= top and box[2] <= right and box[3] <= bottom
            if inside and not any(overlap(box, other) for other in taken):
                taken.append(box)
                yield mark._replace(x=x, y=y), x0 < x - 0.5 * size
                break


def _mark(figure: Figure, mark: Mark, size: float, at_left: bool) -> None:
    """Draw a dot and its text on the sheet."""
    from matplotlib.patches import Ellipse

    width, height = figure.get_size_inches() * _DPI
    at = mark.x / width, 1.0 - mark.y / height
    shape = Ellipse(
        at, 0.5 * size / width, 0.5 * size / height, transform=figure.transFigure,
        facecolor=mark.colour, edgecolor=_EDGE, linewidth=0.05 * size,
    )  # fmt: skip
    figure.add_artist(shape)
    x = mark.x - 0.5 * size if at_left else mark.x + 0.5 * size
    _text(figure, x, mark.y, mark.text, size, "right" if at_left else "left")


def _swatch(figure: Figure, colour: str, box: tuple[float, float, float], unit: float) -> None:
    """Draw the square of a legend entry: left and top side, and its size, pixels."""
    from matplotlib.patches import Rectangle

    left, top, size = box
    width, height = figure.get_size_inches() * _DPI
    if colour.startswith(LINE):
        colour, tall = colour.removeprefix(LINE), 0.25 * size
    else:
        tall = size
    corner = left / width, 1.0 - (top + 0.5 * (size + tall)) / height
    shape = Rectangle(corner, size / width, tall / height, transform=figure.transFigure)
    if colour == HATCHED:
        shape.set(facecolor="#00000060", edgecolor="white", hatch="////", linewidth=0.1 * unit)
    else:
        shape.set(facecolor=colour, edgecolor=_EDGE, linewidth=0.1 * unit)
    figure.add_artist(shape)


def _text(figure: Figure, x: float, y: float, text: str, size: float, side: str = "left") -> None:
    """Draw text `size` pixels high, vertically centred on y (pixels from the top), from or up to x."""
    from matplotlib.patheffects import withStroke

    width, height = figure.get_size_inches() * _DPI
    if side == "right":  # text with an outline is drawn wider than it is laid out
        x -= 0.04 * 0.62 * size * len(text)
    said = figure.text(
        x / width, 1.0 - y / height, text, size=size * 72.0 / _DPI, color="white", family="DejaVu Sans",
        va="center", ha=side,
    )  # fmt: skip
    said.set_path_effects([withStroke(linewidth=0.22 * size, foreground=_EDGE)])
