"""A server of tiles in Web Mercator whose colours say which tile each is."""

import functools
import io
import re

import numpy as np
from lying_server import Reply
from PIL import Image

FRESH = {"Cache-Control": "max-age=3600", "ETag": '"1"'}
_PATH = re.compile(r"/(\d+)/(\d+)/(-?\d+)\.png$")


def colour(level, column, row):
    """Colour of a tile; neighbours of all kinds differ by a lot."""
    return (column * 37 + level * 90) % 256, (row * 53 + level * 60) % 256, (level * 50 + column * 3) % 256


def png(pixels):
    """A picture (h, w, 3 or 4) as PNG."""
    stream = io.BytesIO()
    Image.fromarray(np.asarray(pixels, np.uint8)).save(stream, "PNG", compress_level=1)
    return stream.getvalue()


@functools.cache
def tile(level, column, row, side=256):
    """A tile of its colour."""
    return png(np.broadcast_to(np.array(colour(level, column, row), np.uint8), (side, side, 3)))


class Tiles(dict):
    """Answers of a server: tiles at /.../LEVEL/COLUMN/ROW.png, made on request.

    Attributes
    ----------
    highest
        Finest level that is there.
    gone
        (level, column, row) of tiles that are not.
    """

    def __init__(self, highest=30, side=256, gone=(), south=False):
        super().__init__()
        self.highest, self.side, self.gone, self.south = highest, side, set(gone), south

    def get(self, path, default=None):
        """Answer of a path."""
        found = _PATH.search(path)
        if path in self or not found:
            return super().get(path, default)
        level, column, row = map(int, found.groups())
        if self.south:
            row = (1 << level) - 1 - row
        there = 0 <= column < 1 << level and 0 <= row < 1 << level and level <= self.highest
        if not there or (level, column, row) in self.gone:
            return Reply(404, b"no such tile")
        return Reply(200, tile(level, column, row, self.side), FRESH)
