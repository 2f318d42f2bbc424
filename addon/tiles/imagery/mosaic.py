"""Mosaic of the tiles of an area; coarser tiles replace missing tiles."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ...errors import InputError, input_error
from ...progress import Progress, silent
from ..sources import MissingError
from ..sources._source import missing
from ..sources.http import Http
from .address import TileAddress

Pixels = NDArray[np.uint8]
_MAX_BYTES = 16 << 20  # of a tile
_SIDES = (128, 256, 512, 1024)
_KINDS = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff")
_MAX_MISSES = 16  # consecutive tiles without a coarser one either


@dataclass(frozen=True)
class Patch:
    """Tiles of one level, columns and rows from first to last + 1; columns may cross the date line."""

    level: int
    columns: tuple[int, int]
    rows: tuple[int, int]

    def tiles(self) -> Iterator[tuple[int, int]]:
        """Iterate over column and row of each tile."""
        return ((x, y) for y in range(*self.rows) for x in range(*self.columns))

    @property
    def size(self) -> tuple[int, int]:
        """Tiles across and down."""
        return self.columns[1] - self.columns[0], self.rows[1] - self.rows[0]


class TileServer:
    """Tiles of a server as pixels; each is requested once.

    Attributes
    ----------
    side
        Pixels along the side of a tile, from the first tile; 0: not known yet.
    missing
        Name and reason of missing tiles, by level, column and row.
    """

    def __init__(self, source: Http, address: TileAddress) -> None:
        self.source, self.address = source, address
        self.side = 0
        self.missing: dict[tuple[int, int, int], tuple[str, str]] = {}
        self._known: dict[tuple[int, int, int], Pixels | None] = {}
        self._consecutive_misses = 0

    def mosaic(self, patch: Patch, progress: Progress = silent) -> Pixels:
        """Assemble the tiles of a patch into one picture (h, w, 4), north up; gaps are transparent.

        Raises
        ------
        InputError
            The server stopped answering, or has no tile of the scene.
        """
        self.fetch_ahead(patch, progress)
        found = {tile: self.best_available(patch.level, *tile) for tile in patch.tiles()}
        if not self.side:
            raise self._no_tile_error()
        height, width = (count * self.side for count in patch.size[::-1])
        whole = np.zeros((height, width, 4), np.uint8)
        for (x, y), pixels in found.items():
            left, top = (x - patch.columns[0]) * self.side, (y - patch.rows[0]) * self.side
            if pixels is not None:
                whole[top : top + self.side, left : left + self.side] = pixels
        return whole

    def fetch_ahead(self, patch: Patch, progress: Progress = silent) -> None:
        """Fetch the tiles of a patch, several at a time."""
        every = [tile for tile in patch.tiles() if self._tile_key(patch.level, *tile) not in self._known]
        with ThreadPoolExecutor(self.source.parallel) as pool:
            for first in range(0, len(every), self.source.parallel):
                part = every[first : first + self.source.parallel]
                bodies = pool.map(lambda tile: self._fetch_body(patch.level, *tile), part)
                for (x, y), body in zip(part, bodies, strict=True):
                    self._store_body(self._tile_key(patch.level, x, y), body)
                progress(first + len(part), len(every), "tiles of the orthophoto")

    def best_available(self, level: int, column: int, row: int) -> Pixels | None:
        """Return a tile, or the enlarged part of the next coarser available tile; None without any."""
        pixels = self.tile(level, column, row)
        for up in range(1, level - self.address.lowest + 1):
            if pixels is not None:
                break
            coarse = self.tile(level - up, column >> up, row >> up)
            pixels = None if coarse is None else _enlarge_part(coarse, up, column, row)
        self._consecutive_misses = 0 if pixels is not None else self._consecutive_misses + 1
        if self._consecutive_misses == _MAX_MISSES and not self.side:
            raise self._no_tile_error()
        return pixels

    def tile(self, level: int, column: int, row: int) -> Pixels | None:
        """Return the pixels of a tile (side, side, 4); None if it is missing."""
        key = self._tile_key(level, column, row)
        if key not in self._known:
            self._store_body(key, self._fetch_body(*key))
        return self._known[key]

    def _no_tile_error(self) -> InputError:
        """Make the error of a server without any tile of the scene."""
        name, reason = next(iter(self.missing.values()), ("the orthophoto", "has no tiles"))
        return input_error(name, f"{reason}; the server has no tile of the scene")

    def _tile_key(self, level: int, column: int, row: int) -> tuple[int, int, int]:
        return level, column % (1 << level), row

    def _fetch_body(self, level: int, column: int, row: int) -> bytes | MissingError:
        if not 0 <= row < 1 << level:
            return missing(f"row {row} of level {level}", "lies outside of the Web Mercator map")
        source = self.source
        try:
            return source.read(source.resolve(source.root, self.address.url(level, column, row)), _MAX_BYTES)
        except MissingError as error:
            return error

    def _store_body(self, key: tuple[int, int, int], body: bytes | MissingError) -> None:
        name = self.source.name(self.source.resolve(self.source.root, self.address.url(*key)))
        try:
            if isinstance(body, MissingError):
                raise body
            pixels = decode(body, name)
            if self.side not in (0, len(pixels)):
                raise missing(name, f"is {len(pixels)} pixels large, others {self.side}")
        except MissingError as error:
            self.missing[key], self._known[key] = (name, error.reason), None
        else:
            self.side, self._known[key] = len(pixels), pixels


def decode(body: bytes, name: str) -> Pixels:
    """Decode a PNG or JPEG to pixels (side, side, 4).

    Raises
    ------
    MissingError
        Its format or shape is unsupported, or it is damaged.
    """
    if not body.startswith(_KINDS):
        raise missing(name, "is not a PNG or JPEG")
    try:
        read = sensor.decode_image(body, name)
    except InputError as error:
        raise missing(name, error.reason) from None
    height, width, bands = read.shape
    if height != width or height not in _SIDES:
        raise missing(name, f"is not a tile: {width} x {height} pixels")
    whole = np.full((height, width, 4), 255, np.uint8)
    read = (read * np.float32(255.0) + np.float32(0.5)).astype(np.uint8)
    whole[..., :3] = read[..., :3] if bands > 2 else read[..., :1]
    if bands in (2, 4):
        whole[..., 3] = read[..., -1]
    return whole


def _enlarge_part(coarse: Pixels, up: int, column: int, row: int) -> Pixels | None:
    """Enlarge the part of a tile `up` levels coarser that a finer tile covers, by repeating texels."""
    side, count = len(coarse), 1 << up
    at = (np.arange(side) + 0.5) / side
    rows, columns = (
        np.minimum(((place % count + at) / count * side).astype(int), side - 1) for place in (row, column)
    )
    return coarse[np.ix_(rows, columns)]
