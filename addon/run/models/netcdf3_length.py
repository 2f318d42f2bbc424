"""Expected length of a classic netCDF file; the library reads a truncated one as zeros without an error.

Format: "The NetCDF Classic Format Specification" in Unidata's NetCDF User's Guide (CDF-1, 2 and 5).
"""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import BinaryIO

_BYTES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}  # bytes of a number, by nc_type
_UNSAID = {4: 0xFFFFFFFF, 8: 0xFFFFFFFFFFFFFFFF}  # record counts of files still being written


def needed(path: Path) -> int:
    """Compute the number of bytes up to the end of the last value in a file's header.

    Raises
    ------
    ValueError, KeyError, struct.error
        The header is damaged or incomplete.
    """
    with path.open("rb") as file:
        version = file.read(4)[3]
        return _Header(file, 8 if version == 5 else 4, 4 if version == 1 else 8).end()


class _Header:
    """Header parser; counts have `count` bytes, file offsets `place` bytes."""

    def __init__(self, file: BinaryIO, count: int, place: int) -> None:
        self.file, self.width, self.place = file, count, place

    def number(self, width: int) -> int:
        return struct.unpack(">I" if width == 4 else ">Q", self.file.read(width))[0]

    def count(self) -> int:
        return self.number(self.width)

    def list_of(self) -> range:
        self.number(4)  # tag
        return range(self.count())

    def skip(self, size: int) -> None:
        self.file.seek(-(-size // 4) * 4, 1)

    def attributes(self) -> None:
        for _ in self.list_of():
            self.skip(self.count())
            kind = self.number(4)
            self.skip(self.count() * _BYTES[kind])

    def end(self) -> int:
        records = self.count()
        sides = []
        for _ in self.list_of():
            self.skip(self.count())
            sides.append(self.count())
        self.attributes()
        ends, moving = [0], []
        for _ in self.list_of():
            self.skip(self.count())
            shape = [sides[self.count()] for _ in range(self.count())]
            self.attributes()
            size = _BYTES[self.number(4)]
            self.count()  # vsize, which may be wrong
            begin = self.number(self.place)
            if shape and shape[0] == 0:  # record dimension
                moving.append((begin, size * math.prod(shape[1:])))
            else:
                ends.append(begin + size * math.prod(shape))
        if moving and records not in (0, _UNSAID[self.width]):
            step = sum(-(-size // 4) * 4 for _, size in moving) if len(moving) > 1 else moving[0][1]
            ends += [begin + (records - 1) * step + size for begin, size in moving]
        return max(ends)
