"""Near copies of pictures in different splits, by a perceptual hash (difference hash) of 256 bits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import files

SIDE = 16  # rows of the small picture, which has one more column
MOST_BITS = 12  # of 256 that differ between near copies (by eye)
MOST_DIFFERENCE = 4.0  # mean difference of grey values 0..255 between near copies (by eye)
PLAIN = 3.0  # standard deviation of grey values along rows, below which pictures are not compared (by eye)
_ROWS = 512  # of a block


@dataclass(frozen=True)
class Fingerprint:
    """Fingerprint of a picture.

    Attributes
    ----------
    grey
        (16, 17) grey values, 0..255.
    """

    index: int
    split: str
    grey: NDArray[np.float32]

    @property
    def is_plain(self) -> bool:
        """True if the picture is too even along its rows, such as a night without lights or a sky in fog."""
        return float((self.grey - self.grey.mean(axis=1, keepdims=True)).std()) < PLAIN


def grey(path: Path) -> NDArray[np.float32]:
    """Reduce a picture to (16, 17) grey values.

    Raises
    ------
    OSError
        The picture is damaged or truncated.
    """
    from PIL import Image

    with files.open_picture(path) as opened:
        small = opened.convert("L").resize((SIDE + 1, SIDE), Image.Resampling.BOX)
    return np.asarray(small, np.float32)


def find(prints: Sequence[Fingerprint]) -> Iterator[tuple[Fingerprint, Fingerprint]]:
    """Yield pairs of near copies that are in different splits."""
    structured = [each for each in prints if not each.is_plain]
    if not structured:
        return
    values = np.stack([each.grey for each in structured])
    signs = np.where(np.diff(values, axis=2) > 0.0, np.float32(1.0), np.float32(-1.0)).reshape(
        len(structured), -1
    )
    splits = np.array([each.split for each in structured])
    for first in range(0, len(structured), _ROWS):
        block = slice(first, first + _ROWS)
        bits = (signs.shape[1] - signs[block] @ signs.T) / 2.0
        near = (bits <= MOST_BITS) & (splits[block, None] != splits[None, :])
        for row, column in np.argwhere(near):
            a, b = first + int(row), int(column)
            if a < b and np.abs(values[a] - values[b]).mean() <= MOST_DIFFERENCE:
                yield structured[a], structured[b]
