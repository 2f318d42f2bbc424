"""Colour tags in the frames of ProRes films, which Blender leaves unspecified (SMPTE RDD 36, 5.1)."""

from __future__ import annotations

import struct
from pathlib import Path

from ..errors import input_error
from . import mp4_boxes

_MARK, _TAGS = b"icpf", 22  # bytes from a frame's start to primaries, transfer function and matrix
_BT709 = bytes([1, 1, 1])


def tag_colours(path: Path) -> None:
    """Tag each frame as BT.709, as the film's `colr` box is.

    Raises
    ------
    InputError
        The film is not ProRes.
    """
    try:
        with path.open("r+b") as film:
            parts = list(mp4_boxes.of_file(film, path.stat().st_size))
            (start, end) = next((start, end) for kind, start, end in parts if kind == b"moov")
            film.seek(start + 8)
            tables = mp4_boxes.find(film.read(end - start - 8), b"trak", b"mdia", b"minf", b"stbl") or b""
            for place in _samples(tables):
                film.seek(place + 4)
                if film.read(4) != _MARK:
                    raise ValueError
                film.seek(place + _TAGS)
                film.write(_BT709)
    except (StopIteration, struct.error, ValueError):
        raise input_error(
            path, "is not a ProRes film: Blender wrote a damaged file; render it again"
        ) from None


def _samples(tables: bytes) -> list[int]:
    """List the offset of each frame in the file, by sizes, chunks and samples per chunk."""
    sizes = mp4_boxes.find(tables, b"stsz") or b""
    same, count = struct.unpack_from(">2I", sizes, 4)
    lengths = [same] * count if same else list(struct.unpack_from(f">{count}I", sizes, 12))
    wide = mp4_boxes.find(tables, b"co64")
    chunks = wide or mp4_boxes.find(tables, b"stco") or b""
    starts = struct.unpack_from(f">{struct.unpack_from('>I', chunks, 4)[0]}{'Q' if wide else 'I'}", chunks, 8)
    runs_box = mp4_boxes.find(tables, b"stsc") or b""
    runs = list(struct.iter_unpack(">3I", runs_box[8 : 8 + 12 * struct.unpack_from(">I", runs_box, 4)[0]]))
    places, left = [], iter(lengths)
    for number, place in enumerate(starts, start=1):
        per_chunk = next(many for first, many, _ in reversed(runs) if first <= number)
        for _, length in zip(range(per_chunk), left, strict=False):
            places.append(place)
            place += length
    return places
