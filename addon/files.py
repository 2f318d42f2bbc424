"""Files that are whole or not there: they get their names once all of them has reached the disk."""

from __future__ import annotations

import contextlib
import os
import uuid
from collections.abc import Callable
from pathlib import Path

from .errors import writing


def publish(part: Path, path: Path) -> None:
    """Give a finished temporary file of the same disk its name, once what is in it has reached the disk.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """
    with writing(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        with part.open("r+b") as file:  # Windows brings nothing to the disk through a handle for reading
            os.fsync(file.fileno())
        part.replace(path)
        _sync_folder(path.parent)


def part_of(path: Path) -> Path:
    """Name for `path` while it is made: beside it, of the same kind, and of no other thread or process."""
    return path.with_name(f".{path.stem}.{uuid.uuid4().hex[:12]}.part{path.suffix}")


def write(path: Path, put: Callable[[Path], object]) -> None:
    """Have ``put(part)`` write a temporary file and publish it.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """
    part = part_of(path)
    try:
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            put(part)
        publish(part, path)
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def _sync_folder(folder: Path) -> None:
    """Bring a folder's names to the disk, where the system can: Windows opens no folders."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
