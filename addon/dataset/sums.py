"""SHA256SUMS: the hash of each file of a data set; ``sha256sum -c SHA256SUMS`` checks them."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

from .. import output
from ..errors import reading
from ..files import read_text

NAME = "SHA256SUMS"


def paths(folder: Path) -> Iterator[str]:
    """Yield the paths of all files relative to the folder, sorted, except SHA256SUMS and hidden files."""
    for path in _walk(folder):
        if not _name(path).startswith(".") and path != NAME:
            yield path


def leftovers(folder: Path) -> Iterator[str]:
    """Yield temporary files that a killed process left, relative to the folder."""
    for path in _walk(folder):
        if _name(path).startswith(".") and ".part" in _name(path):
            yield path


def _walk(folder: Path) -> list[str]:
    """List the files outside of hidden folders, sorted."""
    found = []
    for parent, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".")]
        found += [(Path(parent) / name).relative_to(folder).as_posix() for name in names]
    return sorted(found)


def _name(path: str) -> str:
    return path.rpartition("/")[2]


def write(folder: Path, overwrite: bool = False) -> dict[str, str]:
    """Write the hash of each file, and return them by path."""
    found = {path: digest(folder / path) for path in paths(folder)}
    text = "".join(f"{value}  {path}\n" for path, value in found.items())
    output.write_text(folder / NAME, text, overwrite)
    return found


def read(folder: Path) -> dict[str, str]:
    """Read the hash of each file by its path; lines that are not hashes are left out."""
    with reading(folder / NAME):
        lines = read_text(folder / NAME).splitlines()
    pairs = (line.split("  ", 1) for line in lines)
    return {pair[1]: pair[0] for pair in pairs if len(pair) == 2 and len(pair[0]) == 64}


def digest(path: Path) -> str:
    """Compute the SHA-256 of a file."""
    with reading(path), path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
