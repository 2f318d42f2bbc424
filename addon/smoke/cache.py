"""Folders of smoke volumes in a cache: which there are, and which may go. Needs no Blender."""

from __future__ import annotations

import contextlib
import os
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .. import files, leases
from ..errors import Error, input_error, writing

IN_USE = 600.0  # s after the last sign of use; also how long a file in the making may stand still
_SIGN = 60.0  # s between two signs
_MAGIC = b" BDV\0\0\0\0"
_OURS = re.compile(r"\.?((smoke|far|moment)_\d{6,}|state)(\.[0-9a-f]{12}\.part)?\.(vdb|npz)|state\.lock")


@dataclass(frozen=True)
class CachedVolumes:
    """The volumes of one shot: their folder, how large they are, and when they were used last (s, epoch)."""

    folder: Path
    bytes: int
    used: float

    @property
    def in_use(self) -> bool:
        """Whether a bake or a render may be using them now."""
        return time.time() - self.used < IN_USE


def list_volumes(cache: Path) -> list[CachedVolumes]:
    """The volumes in a cache, those used last first. What is not ours is left out."""
    found = []
    for folder in cache.iterdir() if cache.is_dir() else ():
        if re.fullmatch("[0-9a-f]{16}", folder.name) and folder.is_dir() and not folder.is_symlink():
            with contextlib.suppress(OSError):
                found.append(_measure(folder))
    return sorted(found, key=lambda each: -each.used)


def beyond(volumes: list[CachedVolumes], limit: int) -> list[CachedVolumes]:
    """Those that have to go so that the rest, used later, has at most `limit` bytes. Never any in use."""
    left, going = limit - sum(each.bytes for each in volumes if each.in_use), []
    for each in sorted((each for each in volumes if not each.in_use), key=lambda each: -each.used):
        left -= each.bytes
        if left < 0:
            going.append(each)
    return going


def remove(volumes: CachedVolumes) -> bool:
    """Remove a shot's volumes unless they are in use by now. Files that are not ours stay."""
    if _measure(volumes.folder).in_use:
        return False
    for path in volumes.folder.iterdir():
        if _OURS.fullmatch(path.name):
            path.unlink(missing_ok=True)
    with contextlib.suppress(OSError):
        volumes.folder.rmdir()
    return True


@contextlib.contextmanager
def in_use(*folders: Path) -> Iterator[None]:
    """Give signs of use: the time of change of a folder is that of its last use."""

    def sign() -> None:
        for folder in folders:
            with contextlib.suppress(OSError):
                os.utime(folder)

    for folder in folders:
        with writing(folder):
            os.utime(folder)
    with leases.signs(_SIGN, sign):
        yield


def sweep(folder: Path) -> None:
    """Remove unfinished files that nobody has written to for long."""
    for path in folder.glob(".*.part.*"):
        with contextlib.suppress(OSError):
            if time.time() - path.stat().st_mtime > IN_USE:
                path.unlink()


def check(path: Path, size: int) -> None:
    """Look whether a volume that was just written is whole.

    Raises
    ------
    InputError
        It is missing, cut off or something else.
    """
    with writing(path), path.open("rb") as file:
        begins = file.read(len(_MAGIC))
        whole = file.seek(0, 2) == size
    if begins != _MAGIC or not whole:
        raise input_error(path, 0, 0, "is cut off; free some room on the disk and bake it again")


def publish(part: Path, path: Path, size: int) -> None:
    """Give a complete volume of so many bytes its name. Who comes second replaces it by the same."""
    try:
        check(part, size)
        files.publish(part, path)
    except Error:  # Windows replaces no file that is being read
        part.unlink(missing_ok=True)
        if not path.exists():
            raise


def _measure(folder: Path) -> CachedVolumes:
    """A folder's volumes. Of those that lie in several folders (see `shared_frames`) each has its part."""
    states = [path.stat() for path in folder.iterdir() if _OURS.fullmatch(path.name)]
    size = sum(state.st_size // max(state.st_nlink, 1) for state in states)
    return CachedVolumes(folder, size, folder.stat().st_mtime)
