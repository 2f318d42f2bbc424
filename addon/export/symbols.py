"""Symbols of an export, drawn with NumPy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def draw(colour: str, square: bool = False, cross: str = "", side: int = 64) -> NDArray[np.uint8]:
    """Draw a white disc or square with an edge, and a cross, of these colours; (side, side, 4).

    It is drawn four times larger and averaged, so that edges are smooth.
    """
    fine = 4 * side
    y, x = (np.mgrid[:fine, :fine] + 0.5) / fine * 2.0 - 1.0
    away = np.maximum(abs(x), abs(y)) if square else np.hypot(x, y)
    picture = np.zeros((fine, fine, 4))
    picture[away < 0.95] = (*_rgb(colour), 255)
    picture[away < 0.7] = 255
    if cross:
        on = (np.minimum(abs(x - y), abs(x + y)) < 0.2) & (np.maximum(abs(x), abs(y)) < 0.5)
        picture[on] = (*_rgb(cross), 255)
    alpha = picture[..., 3:]
    blocks = (picture * np.concatenate([alpha / 255.0] * 3 + [np.ones_like(alpha)], axis=-1)).reshape(
        side, 4, side, 4, 4
    )
    mean = blocks.mean(axis=(1, 3))
    mean[..., :3] /= np.maximum(mean[..., 3:] / 255.0, 1.0e-9)
    return np.round(mean).astype(np.uint8)


def _rgb(colour: str) -> tuple[int, ...]:
    return tuple(int(colour[i : i + 2], 16) for i in (1, 3, 5))
