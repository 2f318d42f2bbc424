"""File verification: damaged pictures and films are never entered in a store."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
from firetwin_core import sensor

from ..errors import Error, full_disk_error, input_error, is_nearly_full
from ..files import read_json

_PNG_END = b"\0\0\0\0IEND\xaeB`\x82"


def picture(path: Path, size: tuple[int, int]) -> None:
    """Decode a picture or array of `size` (width, height), or parse a JSON file, completely.

    Raises
    ------
    InputError
        The file is missing, truncated or has another size.
    """
    if path.suffix == ".json":
        return _text(path)
    try:
        array = path.suffix == ".npy"
        height, width = (np.load(path) if array else sensor.read_image(path)).shape[:2]
        complete = path.suffix != ".png" or _end(path, len(_PNG_END)) == _PNG_END
    except (Error, OSError, ValueError, EOFError) as error:
        raise _damage_error(path, getattr(error, "reason", str(error))) from None
    if not complete:
        raise _damage_error(path, "is cut off")
    if (width, height) != tuple(size):
        raise _damage_error(path, f"has {width} x {height} pixels instead of {size[0]} x {size[1]}")


def _text(path: Path) -> None:
    try:
        read_json(path)
    except (OSError, ValueError) as error:
        raise _damage_error(path, f"is not JSON: {error}") from None


def film(path: Path) -> None:
    """Parse all boxes of an MP4 film.

    Raises
    ------
    InputError
        The file is missing or truncated.
    """
    kinds = set()
    try:
        whole, place = path.stat().st_size, 0
        with path.open("rb") as file:
            while place < whole:
                file.seek(place)
                length, kind = struct.unpack(">I4s", file.read(8))
                length = struct.unpack(">Q", file.read(8))[0] if length == 1 else length or whole - place
                kinds.add(kind)
                place += max(length, 8)
    except (OSError, struct.error):
        raise _damage_error(path, "is missing or cut off") from None
    if place != whole or not {b"ftyp", b"moov", b"mdat"} <= kinds:
        raise _damage_error(path, "is cut off")


def _end(path: Path, count: int) -> bytes:
    with path.open("rb") as file:
        file.seek(-count, 2)
        return file.read()


def _damage_error(path: Path, reason: str) -> Exception:
    if is_nearly_full(path):
        return full_disk_error(path)
    return input_error(path, f"{reason}: Blender wrote a damaged file; render it again")
