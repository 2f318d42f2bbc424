"""PNG pictures of an export, with the standard library and NumPy alone."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def png(pixels: NDArray[np.uint8]) -> bytes:
    """Encode sRGB pixels with alpha (h, w, 4), first row on top."""
    height, width, _ = pixels.shape
    rows = np.zeros((height, 1 + 4 * width), np.uint8)  # each begins with filter 0
    rows[:, 1:] = pixels.reshape(height, -1)
    header = struct.pack(">2I5B", width, height, 8, 6, 0, 0, 0)
    chunks = (b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b"")
    return _SIGNATURE + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


def symbol(colour: str, square: bool = False, cross: str = "", side: int = 64) -> NDArray[np.uint8]:
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
