"""Layout of a slate, the picture before a review film: rows of a label and a text."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

Row = Sequence[str]
"""Label and text; a text without a label is a headline."""

_HEADLINE, _STEP, _LABELS = 2.0, 1.6, 6.0  # in sizes of text: headline, step of lines, column of labels
_GAP = 0.8  # below a headline, in sizes of text
_ROWS, _EYE_ROWS = 26, 80  # sizes of text in the height of a picture, and of an eye
_LEFT, _EYE_LEFT = 0.08, 0.38  # margins at left and right, fractions of the width


class Place(NamedTuple):
    """A text with its size, and its left end and baseline from the lower left corner, pixels."""

    text: str
    size: float
    left: float
    base: float


def lay_out(
    rows: Iterable[Row], width: int, height: int, around: bool, measure: Callable[[str, float], float]
) -> list[Place]:
    """Lay out the rows in the middle of a picture; texts that are too long shrink to their room.

    Parameters
    ----------
    around
        The picture is a stereo panorama, one eye above the other: each eye shows the rows.
    measure
        Function that returns the width of a text in a size, pixels.
    """
    rows, eye = list(rows), height // 2 if around else height
    unit, margin = eye / (_EYE_ROWS if around else _ROWS), width * (_EYE_LEFT if around else _LEFT)
    sizes = [unit if label else _HEADLINE * unit for label, _ in rows]
    base: float = 0.5 * (eye + _STEP * sum(sizes))
    places: list[Place] = []
    for (label, text), size in zip(rows, sizes, strict=True):
        base -= _STEP * size
        left = margin + (_LABELS * unit if label else 0.0)
        fitting = size * min(1.0, (width - margin - left) / max(measure(text, size), 1e-6))
        places += [Place(label, size, margin, base)] * bool(label) + [Place(text, fitting, left, base)]
        base -= 0.0 if label else _GAP * unit
    return [
        place._replace(base=place.base + above)
        for above in ((0, eye) if around else (0,))
        for place in places
    ]
