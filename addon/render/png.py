"""PNG metadata: removal of the render times that Cycles writes, so that equal pictures are equal files."""

from __future__ import annotations

import struct
from pathlib import Path

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_TIMES = b"cycles."


def remove_render_times(path: Path) -> None:
    """Remove Cycles' text chunks; other or truncated files are unchanged."""
    data = path.read_bytes()
    kept, place = [_SIGNATURE], len(_SIGNATURE)
    while place + 12 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, place)
        chunk = data[place : place + length + 12]
        if kind != b"tEXt" or not chunk[8:].startswith(_TIMES):
            kept.append(chunk)
        place += length + 12
    if data.startswith(_SIGNATURE) and place == len(data):
        path.write_bytes(b"".join(kept))
