"""Record of the files that Firetwin wrote into a folder: their hashes in a hidden file.

It has the format of ``sha256sum``. A file that it lists with its present hash is Firetwin's and unchanged,
and may be replaced (see `output`). A hash is added before its file gets its name, and the hash of the file
before stays in the list, so a killed process loses neither.
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Mapping
from pathlib import Path

NAME = ".firetwin.sha256"
_MOST = 1 << 26  # bytes of a record that is read: about 600,000 files; a larger one is nobody's
_COMPACT = 1 << 18  # bytes from which a record with more old lines than new ones is shortened
_FORMER = 2  # hashes of a file that a shortened record keeps: of the present one and of the one before
_FLAGS = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)

Hashes = dict[str, list[str]]


def digest(path: Path) -> str:
    """Compute the SHA-256 of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def read(folder: Path) -> Hashes:
    """Read the hashes of a folder's files by path, the newest last; empty without a record."""
    try:
        handle = os.open(folder / NAME, os.O_RDONLY | _FLAGS)
    except OSError:
        return {}
    about = os.fstat(handle)
    if not stat.S_ISREG(about.st_mode) or about.st_size > _MOST:
        os.close(handle)
        return {}
    with os.fdopen(handle, "rb") as file:
        text = file.read(_MOST).decode("utf-8", "surrogateescape")
    found: Hashes = {}
    for line in text.split("\n"):
        value, _, name = line.partition("  ")
        if name and len(value) == 64:
            found.setdefault(name, []).append(value)
    return found


def add(folder: Path, hashes: Mapping[str, str]) -> None:
    """Add new hashes of files, by path relative to the folder, in one write.

    Raises
    ------
    OSError
        The folder cannot be written, or its record is a link.
    """
    known = read(folder)
    new = {name: value for name, value in hashes.items() if known.get(name, [""])[-1] != value}
    lines = [_line(name, value) for name, value in new.items() if "\n" not in name]
    text = "".join(lines).encode("utf-8", "surrogateescape")
    handle = os.open(folder / NAME, os.O_WRONLY | os.O_APPEND | os.O_CREAT | _FLAGS, 0o666)
    with os.fdopen(handle, "ab") as file:
        file.write(text)
    if (folder / NAME).stat().st_size > _COMPACT:
        _compact(folder)


def _line(name: str, value: str) -> str:
    return f"{value}  {name}\n"


def _compact(folder: Path) -> None:
    """Leave out hashes of versions that no longer exist, if they are the larger part."""
    found = read(folder)
    kept = {name: list(dict.fromkeys(values))[-_FORMER:] for name, values in found.items()}
    if sum(map(len, found.values())) <= 2 * sum(map(len, kept.values())):
        return
    text = "".join(_line(name, value) for name, values in kept.items() for value in values)
    part = folder / f"{NAME}.{os.getpid()}.part"
    part.write_bytes(text.encode("utf-8", "surrogateescape"))
    part.replace(folder / NAME)
