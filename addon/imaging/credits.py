"""Layout of credits in a picture: text, position and size.

A flat picture has a dark strip along its bottom, with the names of services at the left and the credits of
the data at the right. A panorama has a block below the horizon in the picture of each eye, a quarter as wide.
Its lower edge would be illegible, since it is the point straight below. No credit is left out: long ones take
more lines, in smaller text.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

_ROWS, _SHARE, _EYE_SHARE = (
    3,
    54,
    60,
)  # largest number of lines of large text; rows of a picture per row of text
_LEAST, _SMALLEST = 11, 8  # pixels, text size; text with too many lines shrinks to the second
_LINE, _BETWEEN = 1.35, 1.0  # height of a line, and least gap between left and right, in text sizes
_LEFT_MOST = 0.4  # largest share of the width for names of services
_MOST = 0.5  # largest share of the height for the strip
_WIDE, _UNDER = 0.25, 0.26  # panoramas: width of a block, and its top above the eye's lower edge


@dataclass(frozen=True)
class Credits:
    """Credits that a picture must carry.

    Attributes
    ----------
    data
        Notices of the data.
    logo
        Names of services, which are set apart.
    """

    data: tuple[str, ...] = ()
    logo: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.data or self.logo)

    def text(self) -> str:
        """Join all credits in one line."""
        return "; ".join((*self.logo, *self.data))

    def merge(self, other: Credits) -> Credits:
        """Merge with other credits, without duplicates."""
        pairs = ((self.data, other.data), (self.logo, other.logo))
        return Credits(*(tuple(dict.fromkeys((*mine, *more))) for mine, more in pairs))


@dataclass(frozen=True)
class Block:
    """A dark rectangle with lines of text.

    Attributes
    ----------
    left, top, width, height
        Pixels from the picture's upper left corner.
    size
        Text size, pixels.
    at_left, at_right
        Lines from top to bottom; the last ones share a line.
    """

    left: int
    top: int
    width: int
    height: int
    size: int
    at_left: tuple[str, ...]
    at_right: tuple[str, ...]


def blocks(credits: Credits, width: int, height: int, around: bool = False) -> list[Block]:
    """Lay out the credits in a picture.

    Parameters
    ----------
    around
        The picture is a stereo panorama, one eye above the other.

    Raises
    ------
    ValueError
        The credits do not fit into the picture.
    """
    if not credits:
        return []
    if not around:
        found = _fitted(credits, width, height, _SHARE, _MOST * height)
        return [_block(found, 0, height - _tall(found), width)]
    eye, across = height // 2, round(_WIDE * width)
    found = _fitted(credits, across, eye, _EYE_SHARE, _UNDER * eye)
    top = round((1.0 - _UNDER) * eye)
    return [_block(found, (width - across) // 2, top + below, across) for below in (0, eye)]


def strip_height(credits: Credits, width: int, height: int) -> int:
    """Return the number of rows along the bottom of a flat picture that credits take."""
    return sum(block.height for block in blocks(credits, width, height))


_Fitted = tuple[int, tuple[str, ...], tuple[str, ...]]


def _fitted(credits: Credits, width: int, height: int, share: int, most: float) -> _Fitted:
    """Choose the text size, and wrap the lines at the left and at the right."""
    large = max(round(height / share), _LEAST)
    for size in range(large, _SMALLEST - 1, -1):
        fitted = (size, *_lines(credits, width, size))
        if max(len(fitted[1]), len(fitted[2])) <= _ROWS and _tall(fitted) <= most:
            break
    if _tall(fitted) > most:
        raise ValueError(
            f"the credits of the tiles do not fit into a picture of {width} x {height} pixels; "
            f"choose a larger resolution: {credits.text()}"
        )
    return fitted


def _tall(found: _Fitted) -> int:
    size, at_left, at_right = found
    return round(_LINE * size * max(len(at_left), len(at_right)) + 0.5 * size)


def _block(found: _Fitted, left: int, top: int, width: int) -> Block:
    return Block(left, top, width, _tall(found), *found)


def _lines(credits: Credits, width: int, size: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    room = width - size  # half a size at each side
    services = "  ·  ".join(credits.logo)
    at_left = tuple(_wrapped(services, _LEFT_MOST * room if credits.data else room, size))
    taken = max((estimate_width(line, size) for line in at_left), default=-_BETWEEN * size)
    return at_left, tuple(_wrapped("; ".join(credits.data), room - taken - _BETWEEN * size, size))


def _wrapped(text: str, room: float, size: int) -> Iterator[str]:
    """Wrap a text into lines; split words that are longer than a line."""
    line = ""
    for word in _words(text, room, size):
        longer = f"{line} {word}" if line else word
        if line and estimate_width(longer, size) > room:
            yield line
            longer = word
        line = longer
    if line:
        yield line


def _words(text: str, room: float, size: int) -> Iterator[str]:
    for word in text.split():
        part = ""
        for sign in word:
            if part and estimate_width(part + sign, size) > room:
                yield part
                part = ""
            part += sign
        yield part


def estimate_width(text: str, size: float) -> float:
    """Estimate the width of a text in Blender's typeface, pixels: at most a fifth too wide."""
    return size * sum(_advances(text))


def _advances(text: str) -> Iterator[float]:
    """Yield the advance of each letter, in text sizes; measured, and rounded up."""
    for sign in text:
        if ord(sign) >= 0x2E80:  # square characters
            yield 1.05
        elif sign in " ijl.,;:'|!()[]/ft·":
            yield 0.36
        elif sign in "mwMW@%©®":
            yield 0.92
        else:
            yield 0.72 if sign.isupper() else 0.66 if sign.isdigit() else 0.62
