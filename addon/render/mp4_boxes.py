"""Boxes of MP4 and QuickTime films (ISO/IEC 14496-12), and changes to the movie box `moov`."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

CONTAINERS = frozenset({b"moov", b"trak", b"mdia", b"minf", b"stbl"})


def make(kind: bytes, body: bytes) -> bytes:
    """Make a box of its body."""
    return struct.pack(">I4s", 8 + len(body), kind) + body


def split(body: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield kind and body of each box in a body."""
    place = 0
    while place + 8 <= len(body):
        length, kind = struct.unpack_from(">I4s", body, place)
        length = max(length, 8)
        yield kind, body[place + 8 : place + length]
        place += length


def find(body: bytes, *path: bytes) -> bytes | None:
    """Return the body of the first box at a path, such as ``mdia, mdhd``; None if there is none."""
    if not path:
        return body
    for kind, inner in split(body):
        if kind == path[0] and (found := find(inner, *path[1:])) is not None:
            return found
    return None


def of_file(film: BinaryIO, size: int) -> Iterator[tuple[bytes, int, int]]:
    """Yield kind, start and end of each box of a file."""
    place = 0
    while place < size:
        film.seek(place)
        length, kind = struct.unpack(">I4s", film.read(8))
        length = struct.unpack(">Q", film.read(8))[0] if length == 1 else length or size - place
        yield kind, place, place + length
        place += max(length, 8)


def rewrite(path: Path, edit: Callable[[bytes], bytes], more: bytes = b"") -> None:
    """Replace the body of a film's `moov` by its edited form, and append `more` to the file.

    Data after `moov` moves, and the offsets of chunks are updated, including offsets into `more`.
    """
    part = path.with_name(path.name + ".part")
    try:
        with path.open("rb") as film, part.open("wb") as edited_film:
            for kind, start, end in of_file(film, path.stat().st_size):
                film.seek(start)
                if kind == b"moov":
                    body = film.read(end - start)[8:]
                    edited = edit(body)
                    edited_film.write(make(kind, _shift(edited, end, len(edited) - len(body))))
                else:
                    _copy(film, edited_film, end - start)
            edited_film.write(more)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def _shift(body: bytes, end: int, growth: int) -> bytes:
    """Add `growth` bytes to offsets of chunks from `end` on."""
    shifted = b""
    for kind, inner in split(body):
        if kind in CONTAINERS:
            inner = _shift(inner, end, growth)
        elif kind in (b"stco", b"co64"):
            count, letter = struct.unpack_from(">I", inner, 4)[0], "I" if kind == b"stco" else "Q"
            places = struct.unpack_from(f">{count}{letter}", inner, 8)
            moved = (place + growth * (place >= end) for place in places)
            inner = inner[:8] + struct.pack(f">{count}{letter}", *moved)
        shifted += make(kind, inner)
    return shifted


def _copy(film: BinaryIO, target: BinaryIO, count: int) -> None:
    while count > 0:
        count -= target.write(film.read(min(count, 2**20)))
