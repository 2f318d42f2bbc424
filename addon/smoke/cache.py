"""Cache of smoke volumes: listing and eviction of folders, heartbeat of their use. Needs no Blender."""

from __future__ import annotations

import contextlib
import os
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

from .. import files, leases
from ..errors import Error, input_error, writing

IN_USE = 600.0  # s since the last heartbeat; also the age of an unfinished file that counts as abandoned
_HEARTBEAT = 60.0  # s between heartbeats
_MAGIC = b" BDV\0\0\0\0"
_OURS = re.compile(
    r"\.?((smoke|far|flames|moment)_\d{6,}|state)(\.[0-9a-f]{12}\.part)?\.(vdb|npz)|smoke_\d{6,}\.txt|state\.lock"
)


class Cached(Protocol):
    """Entry of a cache that is evicted as a unit."""

    @property
    def bytes(self) -> int:
        """Size, bytes."""

    @property
    def used(self) -> float:
        """Time of last use, s since 1970."""

    @property
    def in_use(self) -> bool:
        """True if the entry must not be evicted."""


_T = TypeVar("_T", bound=Cached)


@dataclass(frozen=True)
class CachedVolumes:
    """Cached volumes of one shot: folder, size in bytes, and time of last use (s, epoch)."""

    folder: Path
    bytes: int
    used: float

    @property
    def in_use(self) -> bool:
        """True if a bake or a render may be using the volumes."""
        return time.time() - self.used < IN_USE


def list_volumes(cache: Path) -> list[CachedVolumes]:
    """List the volumes in a cache, most recently used first. Foreign files are ignored."""
    volumes = []
    for folder in cache.iterdir() if cache.is_dir() else ():
        if re.fullmatch("[0-9a-f]{16}", folder.name) and folder.is_dir() and not folder.is_symlink():
            with contextlib.suppress(OSError):
                volumes.append(_measure(folder))
    return sorted(volumes, key=lambda volume: -volume.used)


def to_evict(volumes: list[_T], limit: int) -> list[_T]:
    """Choose least recently used entries to evict to keep at most `limit` bytes; never entries in use."""
    left, going = limit - sum(volume.bytes for volume in volumes if volume.in_use), []
    for each in sorted((volume for volume in volumes if not volume.in_use), key=lambda each: -each.used):
        left -= each.bytes
        if left < 0:
            going.append(each)
    return going


def remove(volumes: CachedVolumes) -> bool:
    """Remove a shot's volumes unless they are in use. Foreign files stay."""
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
    """Signal use by a heartbeat that touches the folders; their modification time is the time of last use."""

    def heartbeat() -> None:
        for folder in folders:
            with contextlib.suppress(OSError):
                os.utime(folder)

    for folder in folders:
        with writing(folder):
            os.utime(folder)
    with leases.heartbeats(_HEARTBEAT, heartbeat):
        yield


def remove_unfinished(folder: Path) -> None:
    """Remove abandoned unfinished files."""
    for path in folder.glob(".*.part.*"):
        with contextlib.suppress(OSError):
            if time.time() - path.stat().st_mtime > IN_USE:
                path.unlink()


def check(path: Path, size: int) -> None:
    """Check that a volume just written is complete.

    Raises
    ------
    InputError
        The file is missing, truncated or not a volume.
    """
    with writing(path), path.open("rb") as file:
        begins = file.read(len(_MAGIC))
        whole = file.seek(0, 2) == size
    if begins != _MAGIC or not whole:
        raise input_error(path, "is truncated; free disk space and bake it again")


def publish(part: Path, path: Path, size: int) -> None:
    """Rename a complete volume of `size` bytes into place. Concurrent writers write identical files."""
    try:
        check(part, size)
        files.publish(part, path)
    except Error:  # Windows cannot replace an open file
        part.unlink(missing_ok=True)
        if not path.exists():
            raise


def _measure(folder: Path) -> CachedVolumes:
    """Measure a folder's volumes. Volumes linked into several folders (`shared_frames`) count in parts."""
    states = [path.stat() for path in folder.iterdir() if _OURS.fullmatch(path.name)]
    size = sum(state.st_size // max(state.st_nlink, 1) for state in states)
    return CachedVolumes(folder, size, folder.stat().st_mtime)
