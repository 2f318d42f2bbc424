"""Picture of a flame for cards: deep orange at the rim, yellow in the core, transparent outside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..scene import glow
from ..scene.terrain.ground_picture import encode

_SIZE = 256, 128  # rows, columns
_RIM, _CORE = np.array(glow.RIM), np.array(glow.CORE)


def draw(seed: int = 7) -> NDArray[np.uint8]:
    """Draw the picture (rows, columns, 4), sRGB and alpha; the foot of the flame is in the lowest row.

    The colours are black where alpha is 0, so a renderer can also add them to the background.
    """
    rows, columns = _SIZE
    up = 1.0 - (np.arange(rows)[:, None] + 0.5) / rows
    across = 2.0 * (np.arange(columns)[None] + 0.5) / columns - 1.0
    torn = _noise(np.random.default_rng(seed), rows, columns)
    sway = 0.25 * up * np.sin(5.0 * up + 0.7)
    narrow = 0.9 * np.maximum(1.0 - up, 1.0e-6) ** 0.65
    body = 1.0 - np.abs(across + sway) / np.maximum(narrow, 0.02) + 1.6 * (torn - 0.5) * (0.3 + up)
    shape = _step(0.0, 0.6, body) * _step(0.0, 0.06, up) * _step(1.0, 0.85, up)
    hot = _step(0.4, 1.3, body - 0.5 * up)[..., None]
    colour = shape[..., None] * (_RIM + hot * (_CORE - _RIM))
    alpha = np.round(255.0 * shape).astype(np.uint8)
    return np.concatenate([encode(colour), alpha[..., None]], axis=-1)


def _step(low: float, high: float, value: NDArray[np.float64]) -> NDArray[np.float64]:
    part = np.clip((value - low) / (high - low), 0.0, 1.0)
    return part * part * (3.0 - 2.0 * part)


def _noise(random: np.random.Generator, rows: int, columns: int) -> NDArray[np.float64]:
    """Return smooth noise (rows, columns) in 0..1, of three octaves."""
    total, weight = np.zeros((rows, columns)), 0.0
    for cells, part in ((4, 1.0), (8, 0.5), (16, 0.25)):
        lattice = random.random((2 * cells + 1, cells + 1))
        row, column = (
            np.linspace(0.0, count - 1.000001, size)
            for count, size in zip(lattice.shape, (rows, columns), strict=True)
        )
        i, j = row.astype(int)[:, None], column.astype(int)[None]
        u, v = (_step(0.0, 1.0, at - np.floor(at)) for at in (row, column))
        u, v = u[:, None], v[None]
        top = lattice[i, j] * (1.0 - v) + lattice[i, j + 1] * v
        low = lattice[i + 1, j] * (1.0 - v) + lattice[i + 1, j + 1] * v
        total, weight = total + part * (top * (1.0 - u) + low * u), weight + part
    return total / weight
