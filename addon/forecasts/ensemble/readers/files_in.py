"""Files that a user names: files, the files in folders, and the files of members."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TypeVar

from ....errors import input_error

Key = TypeVar("Key", str, int)


def files_in(paths: Iterable[Path]) -> list[Path]:
    """Collect these files and the files in these folders, in the order of their names."""
    inner = [sorted(path.iterdir()) if path.is_dir() else [path] for path in paths]
    return [each for files in inner for each in files if each.is_file()]


def add_member(found: dict[Key, Path], key: Key, path: Path) -> None:
    """Add the file of a member.

    Raises
    ------
    InputError
        A file of another folder is the same member.
    """
    other = found.setdefault(key, path)
    if other.absolute() != path.absolute():
        raise input_error(path, f"is the same member as {other}; convert one folder, or rename a file")
