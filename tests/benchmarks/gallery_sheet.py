"""Contact sheets: pictures in rows and columns with a word over each. Needs Pillow, as matplotlib does."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageDraw

_GAP, _BAND = 8, 20  # px between pictures, and over each for its word
_PAPER, _INK = (24, 24, 24), (230, 230, 230)
_TILE = (640, 360)

Cell = tuple[str, Path | None]


def sheet(
    path: Path,
    title: str,
    rows: Sequence[Sequence[Cell]],
    tile: tuple[int, int] = _TILE,
) -> Path:
    """Write a sheet; a cell is a word and a picture, or None where there is none."""
    wide = max(len(row) for row in rows)
    width = _GAP + wide * (tile[0] + _GAP)
    height = _BAND + _GAP + len(rows) * (tile[1] + _BAND + _GAP)
    paper = Image.new("RGB", (width, height), _PAPER)
    pen = ImageDraw.Draw(paper)
    pen.text((_GAP, 6), title, fill=_INK)
    for j, row in enumerate(rows):
        for i, (word, file) in enumerate(row):
            x, y = (
                _GAP + i * (tile[0] + _GAP),
                _BAND + _GAP + j * (tile[1] + _BAND + _GAP),
            )
            pen.text((x, y + 3), word if file else f"{word}: none", fill=_INK)
            if file:
                paper.paste(_fitted(file, tile), (x, y + _BAND))
    path.parent.mkdir(parents=True, exist_ok=True)
    paper.save(path)
    return path


def _fitted(file: Path, tile: tuple[int, int]) -> Image.Image:
    """A picture in a tile, whole."""
    with Image.open(file) as picture:
        colours = picture.convert("RGB")
    scale = min(tile[0] / colours.width, tile[1] / colours.height)
    size = round(colours.width * scale), round(colours.height * scale)
    paper = Image.new("RGB", tile, _PAPER)
    paper.paste(colours.resize(size), ((tile[0] - size[0]) // 2, (tile[1] - size[1]) // 2))
    return paper
