"""Atomic file writes: a file gets its name after all of its content is on the disk. Reads of limited size."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import sys
import time
import uuid
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from . import limits
from .errors import input_error, refuse_odd, writing

_MARKS = b",", b"[", b"{", b"<"  # each begins a value of JSON, XML or CSV
_BLOCK = 1 << 22  # bytes
_WAITS = (0.05, 0.1, 0.2, 0.4, 0.8) if sys.platform == "win32" else ()  # s


def publish(part: Path, path: Path, durable: bool = True) -> None:
    """Rename a finished temporary file to its final path, after its content has reached the disk (fsync).

    Parameters
    ----------
    durable
        Wait for the disk. If False, a file can be empty or truncated after a power failure; readers of such
        cache files must check the length.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """
    with writing(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        if not durable:
            replace(part, path)
            return
        with part.open("r+b") as file:  # Windows cannot flush through a read-only handle
            os.fsync(file.fileno())
        replace(part, path)
        _sync_folder(path.parent)


def replace(part: Path, path: Path) -> None:
    """Rename a file to `path`, replacing a file there.

    Windows refuses this while a program has either file open. It is repeated for 1.5 s, as virus scanners and
    indexers open new files for moments.
    """
    for seconds in _WAITS:
        try:
            part.replace(path)
        except PermissionError:
            time.sleep(seconds)
        else:
            return
    part.replace(path)


def relative(path: Path, folder: Path) -> Path:
    """Return a path relative to a folder; absolute if no relative path leads to another drive of Windows."""
    try:
        return Path(os.path.relpath(path, folder))
    except ValueError:
        return path.absolute()


def temporary_path(path: Path) -> Path:
    """Return a unique temporary name in the folder of `path`, with the same extension."""
    return path.with_name(f".{path.stem}.{uuid.uuid4().hex[:12]}.part{path.suffix}")


def write(
    path: Path,
    put: Callable[[Path], object],
    durable: bool = True,
) -> None:
    """Write a file atomically: ``put(part)`` writes a temporary file, which is then renamed (see `publish`).

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """
    part = temporary_path(path)
    try:
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            put(part)
        publish(part, path, durable)
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def link_or_copy(path: str | Path, other: str | Path) -> None:
    """Give a file a second name; copy it if the file system has no hard links."""
    try:
        os.link(path, other)
    except OSError:
        shutil.copyfile(path, other)


def write_cached(path: Path, data: bytes) -> None:
    """Write a cache file that is named by its content, unless it exists."""
    with contextlib.suppress(OSError):
        if path.stat().st_size == len(data):
            return
    write(path, lambda part: part.write_bytes(data), durable=False)


def write_text(path: Path, text: str) -> None:
    """Write a text atomically, as UTF-8, with the same line ends on all systems (see `write`)."""
    write(path, lambda part: part.write_text(text, encoding="utf-8", newline="\n"))


def read_text(
    path: Path, encoding: str = "utf-8", errors: str = "strict", most: int = limits.TEXT_BYTES
) -> str:
    """Read a text of at most `most` bytes.

    Raises
    ------
    OSError, ValueError
        It is missing or in another encoding.
    InputError
        It is a pipe or a device, or larger.
    """
    check_size(path, most)
    return path.read_text(encoding=encoding, errors=errors)


def read_json(path: Path) -> Any:
    """Read a JSON file (see `read_text` and `check_text_size`).

    It is also a ValueError if it is not JSON or nested too deeply.
    """
    check_text_size(path)
    try:
        return json.loads(read_text(path))
    except RecursionError:
        raise ValueError("its parts are nested too deeply") from None


def check_size(path: Path, most: int = limits.TEXT_BYTES) -> None:
    """Check that a file is a regular one of at most `most` bytes.

    Raises
    ------
    InputError
        It is not.
    """
    refuse_odd(path)
    size = path.stat().st_size
    if size > most:
        reason = f"has {size / 1e6:,.0f} MB; at most {most / 1e6:,.0f} MB are read: take a part of it"
        raise input_error(path, reason)


def check_text_size(path: Path) -> None:
    """Check that a text file of a user is within `limits.TEXT_BYTES` and `limits.TEXT_VALUES`.

    Raises
    ------
    InputError
        It is not.
    """
    check_size(path, limits.TEXT_BYTES)
    if path.stat().st_size > limits.TEXT_VALUES:
        with path.open("rb") as file:
            check_values(path, iter(lambda: file.read(_BLOCK), b""))


def check_values(path: Path, blocks: Iterable[bytes]) -> None:
    """Check that the text of a file has at most `limits.TEXT_VALUES` values; each takes about 100 bytes.

    Raises
    ------
    InputError
        It has more.
    """
    values = sum(block.count(mark) for block in blocks for mark in _MARKS)
    if values > limits.TEXT_VALUES:
        most = f"at most {limits.TEXT_VALUES:,} are read"
        raise input_error(path, f"has about {values:,} numbers, lists or tags; {most}: take a part of it")


def _sync_folder(folder: Path) -> None:
    """Flush a folder's entries to the disk, where the system supports it; Windows does not."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
