"""Pictures of the ground for tiles."""

from __future__ import annotations

import io
from typing import Protocol

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

Array = NDArray[np.float64]
_QUALITY = 90


class Colours(Protocol):
    """Ground colours at places."""

    resolution: float
    """Size of the source's pixels, m."""

    def __call__(self, latitude: Array, longitude: Array) -> NDArray[np.uint8]:
        """Sample colours (h, w, 3), sRGB, on axes (h,) and (w,) in degrees, both ascending."""
        ...


def draw(colours: Colours, latitude: Array, longitude: Array, pixels: int) -> bytes:
    """Draw a JPEG or PNG of `pixels` x `pixels` between the ends of two axes, north up."""
    rows, columns = (_centres(axis[0], axis[-1], pixels) for axis in (latitude, longitude))
    return encode(colours(rows, columns)[::-1])


def encode(picture: NDArray[np.uint8]) -> bytes:
    """Encode a picture (h, w, 3) as JPEG, or as PNG without Pillow, which Blender's Python does not have."""
    picture = np.ascontiguousarray(picture)
    try:
        from PIL import Image
    except ImportError:
        return sensor.encode_png(picture / np.float32(255.0))
    stream = io.BytesIO()
    Image.fromarray(picture).save(stream, "JPEG", quality=_QUALITY)
    return stream.getvalue()


def kind(data: bytes) -> str:
    """Return the media type of a drawn picture."""
    return "image/png" if data.startswith(b"\x89PNG") else "image/jpeg"


def side(metres: float, resolution: float, least: int = 64, most: int = 512) -> int:
    """Choose the pixels along a tile: a power of two, with at most twice the source's resolution."""
    wanted = int(2 ** np.ceil(np.log2(max(metres / resolution, 1.0))))
    return min(max(wanted, least), most)


def _centres(first: float, last: float, count: int) -> Array:
    return first + (last - first) * (np.arange(count) + 0.5) / count
