"""Temperature colour bar at the right edge of a picture, with tick labels in K, and text at its top."""

from __future__ import annotations

import numpy as np
from firetwin_core import sensor
from numpy.typing import ArrayLike, NDArray

# Bitmap font, 3 x 5 pixels per character, row by row from the top. Pictures are finished without Blender, and
# in Blender, which has no matplotlib, so no typeface is available to both.
_SIGNS = {
    "0": "111101101101111",
    "1": "010110010010111",
    "2": "111001111100111",
    "3": "111001111001111",
    "4": "101101111001001",
    "5": "111100111001111",
    "6": "111100111101111",
    "7": "111001010010010",
    "8": "111101111101111",
    "9": "111101111001111",
    "K": "101101110101101",
    "A": "010101111101101",
    "B": "110101110101110",
    "C": "011100100100011",
    "D": "110101101101110",
    "E": "111100110100111",
    "F": "111100110100100",
    "G": "011100101101011",
    "H": "101101111101101",
    "I": "111010010010111",
    "J": "001001001101010",
    "L": "100100100100111",
    "M": "101111111101101",
    "N": "110101101101101",
    "O": "010101101101010",
    "P": "110101110100100",
    "Q": "010101101110011",
    "R": "110101110101101",
    "S": "011100010001110",
    "T": "111010010010010",
    "U": "101101101101111",
    "V": "101101101101010",
    "W": "101101111111101",
    "X": "101101010101101",
    "Y": "101101010010010",
    "Z": "111001010100111",
    ".": "000000000000010",
    "-": "000000111000000",
    ":": "000010000010000",
    " ": "000000000000000",
}
FOOT = 0.15  # darkest part of the palette, for temperatures below the ground's (by eye)
_STEPS = (1000, 500, 100, 50, 10, 5, 2, 1)
_ENOUGH = 5  # tick marks; scales with fewer use steps below 10 K


def draw(
    picture: NDArray[np.float32], low: float, high: float, palette: str, knee: float, cold: float = 0.0
) -> None:
    """Draw a colour bar into a picture (h, w, 3): the palette of `sensor.colour`, hot at the top, with ticks.

    Pictures that are too small are left unchanged. The parameters are the same as for `paint`.
    """
    height, width = picture.shape[:2]
    size = max(height // 240, 1)  # pixels per font pixel
    if height < 90 or width < 90:
        return
    top, bottom = int(0.08 * height), int(0.92 * height)
    right = width - 3 * size
    left = right - 6 * size
    bar = sensor.colour(np.linspace(1.0, 0.0, bottom - top)[:, None], 0.0, 1.0, palette)
    picture[top - size : bottom + size, left - size : right + size] = 1.0
    picture[top:bottom, left:right] = bar
    for kelvin in choose_ticks(low, high, knee, (bottom - top) / (9.0 * size), cold):
        at = bottom - 1 - round((bottom - 1 - top) * float(scale_position(kelvin, low, high, knee, cold)))
        picture[at : at + 1, left - 3 * size : left] = 1.0
        _write(picture, f"{kelvin:.0f}", left - 4 * size, at, size)
    _write(picture, "K", right + size, top - 5 * size, size)


def write_title(picture: NDArray[np.float32], lines: list[str]) -> None:
    """Write text of capital letters, digits and . - : into the upper left corner of a picture (h, w, 3)."""
    height, width = picture.shape[:2]
    size = max(height // 240, 1)
    for number, line in enumerate(lines):
        right = 3 * size + (4 * len(line) + 1) * size
        if height >= 90 and right <= width:
            _write(picture, line.upper(), right, (7 * number + 6) * size, size)


def paint(
    kelvin: NDArray, low: float, high: float, palette: str, knee: float, cold: float
) -> NDArray[np.float32]:
    """Return the colours (h, w, 3) of temperatures (h, w), K.

    Parameters
    ----------
    low, high, knee
        Temperatures, K, as for `sensor.colour`.
    cold
        K below `low` over which the darkest `FOOT` of the palette extends, for a cold sky; 0: none.
    """
    kelvin = np.where(np.isnan(kelvin), low - cold, kelvin)
    return sensor.colour(scale_position(kelvin, low, high, knee, cold), 0.0, 1.0, palette)


def choose_ticks(low: float, high: float, knee: float, most: float, cold: float = 0.0) -> list[float]:
    """Choose tick values: up to about `most` round temperatures (K), well apart on the scale."""
    ticks: list[float] = []
    for step in _STEPS:
        if step < 10 and len(ticks) >= _ENOUGH:
            break
        for kelvin in np.arange(np.ceil((low - cold) / step) * step, high + 1e-9, step):
            places = [scale_position(tick, low, high, knee, cold) for tick in (*ticks, kelvin)]
            if all(abs(place - places[-1]) >= 1.0 / most for place in places[:-1]):
                ticks.append(float(kelvin))
    return sorted(ticks)


def scale_position(kelvin: ArrayLike, low: float, high: float, knee: float, cold: float = 0.0) -> NDArray:
    """Return the positions of temperatures on the scale, 0..1; see `paint`."""
    kelvin = np.clip(np.asarray(kelvin, np.float64), low - cold, high)
    place = np.log1p(np.maximum(kelvin - low, 0.0) / knee) / np.log1p((high - low) / knee)
    if cold == 0.0:
        return place
    return FOOT * np.minimum((kelvin - low) / cold + 1.0, 1.0) + (1.0 - FOOT) * place


def _write(picture: NDArray[np.float32], text: str, right: int, middle: int, size: int) -> None:
    """Write white characters on black, right-aligned at `right` and centred on the row `middle`."""
    signs = [np.array(list(_SIGNS[sign]), np.float32).reshape(5, 3) for sign in text]
    line = np.concatenate([np.pad(sign, ((1, 1), (1, 0))) for sign in signs], axis=1)
    line = np.kron(np.pad(line, ((0, 0), (0, 1))), np.ones((size, size), np.float32))
    top = min(max(middle - line.shape[0] // 2, 0), picture.shape[0] - line.shape[0])
    left = max(right - line.shape[1], 0)
    picture[top : top + line.shape[0], left : left + line.shape[1]] = line[:, : picture.shape[1] - left, None]
