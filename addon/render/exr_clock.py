"""Times in headers of finished EXR files, rewritten without rendering if frame rate or time zone change.

Frame rate and time zone change no pixels, so they are not inputs of a picture (see `fingerprint`). The store
records them with each EXR, as `KEY`. Needs no Blender.
"""

from __future__ import annotations

import struct
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import sensor

from .. import files
from ..progress import count
from ..shot import exr_tags
from ..shot.shot import Shot
from .fingerprint import Fingerprints
from .picture import Picture
from .store import Store, describe

KEY = "clock"
"""Key of frame rate and time zone in a file's entry in the store."""

_PREAMBLE = 8  # bytes of magic number and version


def value(shot: Shot) -> str:
    """Return frame rate and time zone of a shot, for the store."""
    time = shot.settings.time
    return f"{time.rate} {time.zone}"


def update(shot: Shot, store: Store, kept: Iterable[Picture], made_with: Fingerprints) -> str:
    """Rewrite the times in finished EXR files that have another frame rate or time zone.

    Returns
    -------
    Description for the user; empty if no file changed.
    """
    now, changed = value(shot), 0
    old = store.differing(KEY, now, ".exr")
    for picture in kept if old else ():
        for path in old.keys() & {*picture.files()}:
            rewrite(store.out / path, exr_tags.times(shot, picture.frame))
            entry = old[path] | describe(store.out / path) | {KEY: now}
            store.add(made_with[picture.camera, picture.name], {path: entry})
            changed += 1
    if not changed:
        return ""
    return (
        f"other frame rate or time zone: wrote new times into {count(changed, 'EXR file')}, without rendering"
    )


def rewrite(path: Path, times: dict[str, Any]) -> None:
    """Replace the times (see `exr_tags.times`) in the header of an EXR file with one part."""
    with tempfile.TemporaryDirectory() as folder:
        small = Path(folder) / "times.exr"
        sensor.write_image(small, np.zeros((1, 1), np.float32), times)
        new, _ = _read_header(small.read_bytes())
    data = path.read_bytes()
    old, end = _read_header(data)
    kept = {name: value for name, value in old.items() if name not in exr_tags.TIMES}
    header = kept | {name: value for name, value in new.items() if name in exr_tags.TIMES}
    texts = (name.encode() + b"\0" + header[name] for name in sorted(header))
    head = data[:_PREAMBLE] + b"".join(texts) + b"\0"
    (first,) = struct.unpack_from(
        "<Q", data, end
    )  # the offsets of all blocks of lines end where the first begins
    offsets = np.frombuffer(data, "<i8", (first - end) // 8, end) + (len(head) - end)
    files.write(path, lambda part: part.write_bytes(head + offsets.tobytes() + data[first:]))


def _read_header(data: bytes) -> tuple[dict[str, bytes], int]:
    """Return type, size and value of the attributes by name, as stored, and the position after the header."""
    attributes, place = {}, _PREAMBLE
    while data[place]:
        start = data.index(b"\0", place) + 1
        size = data.index(b"\0", start) + 1
        end = size + 4 + struct.unpack_from("<i", data, size)[0]
        attributes[data[place : start - 1].decode()] = data[start:end]
        place = end
    return attributes, place + 1
