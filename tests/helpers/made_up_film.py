"""A film of made-up bytes, and a reader of its timecode track."""

from __future__ import annotations

import struct
from pathlib import Path

from firetwin.render import mp4_boxes


def write(path: Path, handler: bytes = b"vide") -> None:
    """Write a film of one track with five frames, 5 s long at 1000 units a second."""
    tables = mp4_boxes.make(b"stsz", struct.pack(">3I", 0, 9, 5))
    media = mp4_boxes.make(b"hdlr", struct.pack(">2I4s12x", 0, 0, handler) + b"\0")
    media += mp4_boxes.make(b"minf", mp4_boxes.make(b"stbl", tables))
    header = struct.pack(">5I", 0, 0, 0, 1000, 5000) + bytes(76) + struct.pack(">I", 2)
    moov = mp4_boxes.make(b"mvhd", header) + mp4_boxes.make(b"trak", mp4_boxes.make(b"mdia", media))
    path.write_bytes(mp4_boxes.make(b"mdat", b"frames") + mp4_boxes.make(b"moov", moov))


def read_timecode(path: Path) -> tuple[int, int, int]:
    """Read the number of the first frame, the flags and the frames a second of the timecode track."""
    data = path.read_bytes()
    track = [body for kind, body in mp4_boxes.split(mp4_boxes.find(data, b"moov") or b"") if kind == b"trak"][
        1
    ]
    tables = mp4_boxes.find(track, b"mdia", b"minf", b"stbl") or b""
    entry = (mp4_boxes.find(tables, b"stsd") or b"")[8:]
    flags, _, _, frames = struct.unpack_from(">3IB", entry, 8 + 8 + 4)
    (place,) = struct.unpack_from(">Q", mp4_boxes.find(tables, b"co64") or b"", 8)
    return struct.unpack_from(">I", data, place)[0], flags, frames
